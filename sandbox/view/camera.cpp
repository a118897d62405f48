#include "sandbox/view/camera.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace shatterbox::sandbox::view {

namespace {

/// Position, target and field of view as one point of a space in which the path runs.
Eigen::Matrix<double, 7, 1> point_of(const scene::CameraKey& key) {
  Eigen::Matrix<double, 7, 1> point;
  point << key.position, key.target, key.fov;
  return point;
}

scene::CameraKey on_path(const std::vector<scene::CameraKey>& path, double time) {
  if (time <= path.front().at || path.size() == 1) return path.front();
  if (time >= path.back().at) return path.back();
  const auto after = std::upper_bound(path.begin(), path.end(), time,
                                      [](double t, const scene::CameraKey& key) { return t < key.at; });
  const auto i = static_cast<std::size_t>(after - path.begin());
  const auto slope = [&path](std::size_t k) -> Eigen::Matrix<double, 7, 1> {
    if (k == 0 || k + 1 == path.size())
      return Eigen::Matrix<double, 7, 1>::Zero();  // starts and ends at rest
    return (point_of(path[k + 1]) - point_of(path[k - 1])) / (path[k + 1].at - path[k - 1].at);
  };
  const double span = path[i].at - path[i - 1].at;
  const double s = (time - path[i - 1].at) / span;
  const double s2 = s * s, s3 = s2 * s;
  const Eigen::Matrix<double, 7, 1> point =
      (2 * s3 - 3 * s2 + 1) * point_of(path[i - 1]) + (s3 - 2 * s2 + s) * span * slope(i - 1) +
      (3 * s2 - 2 * s3) * point_of(path[i]) + (s3 - s2) * span * slope(i);
  return {time, point.head<3>(), point.segment<3>(3), point[6]};
}

/// Where a body that starts at `position` would come to lie: the foot of its fall on the nearest plane below
/// it that is at most `kSteepest` steep; its own place if there is none, or if nothing pulls.
Vec3 find_landing(const scene::SceneDescription& scene, const Vec3& position) {
  constexpr double kSteepest = 0.7;  // cosine of the angle between gravity and the plane's normal
  const Vec3& gravity = scene.world.gravity;
  double nearest = std::numeric_limits<double>::max();
  for (const scene::BodyEntry& entry : scene.bodies) {
    if (!std::holds_alternative<scene::PlaneForm>(entry.form)) continue;
    const Vec3 normal = entry.rotation * Vec3::UnitY();
    const double sinking = -normal.dot(gravity);
    if (sinking <= kSteepest * gravity.norm()) continue;
    const double way = normal.dot(position - entry.position) / sinking;
    if (way > 0.0) nearest = std::min(nearest, way);
  }
  return nearest < std::numeric_limits<double>::max() ? Vec3(position + nearest * gravity) : position;
}

struct Extent {
  Vec3 least = Vec3::Constant(std::numeric_limits<double>::max());
  Vec3 most = -Vec3::Constant(std::numeric_limits<double>::max());
  void add(const Vec3& place, double radius) {
    least = least.cwiseMin(place - Vec3::Constant(radius));
    most = most.cwiseMax(place + Vec3::Constant(radius));
  }
  bool is_empty() const { return least.x() > most.x(); }
  Vec3 centre() const { return 0.5 * (least + most); }
  double radius() const { return 0.5 * (most - least).norm(); }
};

constexpr double kRoomForPieces = 1.5;  // times what lies on the floor
constexpr double kWorthGoing = 1.3;     // times as large all would have to be, to be seen at once

/// The fall of all that moves, if all that happens is that it falls: nothing is thrown, follows a path or
/// comes in later.
std::optional<Fall> find_fall(const scene::SceneDescription& scene, const scene::ScenePlan& plan) {
  constexpr double kSideways = 0.5;  // m/s
  Extent from, to;                   // of the centres
  double largest = 0.0;
  Fall fall;
  fall.acceleration = scene.world.gravity.norm();
  if (!(fall.acceleration > 0.0)) return std::nullopt;
  const Vec3 down = scene.world.gravity / fall.acceleration;
  bool moves = false;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const scene::BodyEntry& body = scene.bodies[i];
    const double reach = plan.bodies[i].reach;
    if (body.is_held_back || body.path || body.repeat.every > 0.0) return std::nullopt;
    if (reach <= 0.0) continue;
    const bool is_falling = body.motion == body::Motion::dynamic;
    const double speed = body.velocity.dot(down);
    if (is_falling && (speed < 0.0 || (body.velocity - speed * down).norm() > kSideways)) return std::nullopt;
    for (const Pose& pose : scene::copy_poses(body, scene.world.seed, i)) {
      const Vec3 centre = pose.apply(plan.bodies[i].centre);
      from.add(centre, 0.0);
      to.add(is_falling ? find_landing(scene, centre) : centre, 0.0);
      largest = std::max(largest, reach);
    }
    if (!is_falling) continue;
    fall.speed = moves ? std::min(fall.speed, speed) : speed;
    moves = true;
  }
  if (!moves) return std::nullopt;
  fall.from = from.centre();
  fall.to = to.centre();
  fall.radius_from = from.radius() + largest;
  fall.radius_to = kRoomForPieces * (to.radius() + largest);
  return fall;
}

/// How much of its way it has made, 0 to 1; a mean over a tenth of a second, so that the camera stops softly.
double fallen_share(const Fall& fall, double time) {
  constexpr int kSamples = 5;  // before and after
  constexpr double kApart = 0.01;
  const double way = (fall.to - fall.from).norm();
  double sum = 0.0;
  for (int i = -kSamples; i <= kSamples; ++i) {
    const double t = std::max(time + kApart * i, 0.0);
    sum += std::min((fall.speed + 0.5 * fall.acceleration * t) * t / std::max(way, 1e-9), 1.0);
  }
  return sum / (2 * kSamples + 1);
}

}  // namespace

Subject find_subject(const scene::SceneDescription& scene, const scene::ScenePlan& plan) {
  Extent all;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const double radius = plan.bodies[i].bounding_radius;
    if (radius <= 0.0 || scene.bodies[i].is_held_back) continue;
    for (const Pose& pose : scene::copy_poses(scene.bodies[i], scene.world.seed, i)) {
      all.add(pose.translation, radius);
      if (const auto& path = scene.bodies[i].path) {
        for (const body::Keyframe& key : path->keys) {
          const Vec3 place = pose.translation + (key.position - scene.bodies[i].position);
          all.add(place, radius);
        }
      }
      if (scene.bodies[i].motion != body::Motion::dynamic) continue;
      all.add(find_landing(scene, pose.translation), 0.0);
    }
  }
  if (all.is_empty()) return {};
  Subject subject{all.centre(), all.radius(), find_fall(scene, plan)};
  if (subject.fall &&
      subject.radius < kWorthGoing * std::max(subject.fall->radius_from, subject.fall->radius_to))
    subject.fall.reset();
  return subject;
}

Viewpoint viewpoint_at(const scene::CameraEntry& camera, const Subject& subject, double time) {
  if (!camera.path.empty()) {
    const scene::CameraKey key = on_path(camera.path, time);
    return {key.position, key.target, key.fov};
  }
  Subject seen = subject;
  if (subject.fall && !camera.target && !camera.position) {
    const Fall& fall = *subject.fall;
    const double share = fallen_share(fall, time);
    seen.centre = fall.from + share * (fall.to - fall.from);
    seen.radius = fall.radius_from + share * (fall.radius_to - fall.radius_from);
  }
  const Vec3 target = camera.target.value_or(seen.centre);
  const double half_view = camera.fov * 3.14159265358979 / 360.0;
  const Vec3 away = Vec3(0.45, 0.35, 1.0).normalized() * (1.15 * seen.radius / std::sin(half_view));
  return {camera.position.value_or(target + away), target, camera.fov};
}

}  // namespace shatterbox::sandbox::view
