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

}  // namespace

Subject find_subject(const scene::SceneDescription& scene, const scene::ScenePlan& plan) {
  Vec3 least = Vec3::Constant(std::numeric_limits<double>::max());
  Vec3 most = -least;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const double radius = plan.bodies[i].bounding_radius;
    if (radius <= 0.0 || scene.bodies[i].is_held_back) continue;
    for (const Pose& pose : scene::copy_poses(scene.bodies[i], scene.world.seed, i)) {
      least = least.cwiseMin(pose.translation - Vec3::Constant(radius));
      most = most.cwiseMax(pose.translation + Vec3::Constant(radius));
      if (const auto& path = scene.bodies[i].path) {
        for (const body::Keyframe& key : path->keys) {
          const Vec3 place = pose.translation + (key.position - scene.bodies[i].position);
          least = least.cwiseMin(place - Vec3::Constant(radius));
          most = most.cwiseMax(place + Vec3::Constant(radius));
        }
      }
      if (scene.bodies[i].motion != body::Motion::dynamic) continue;
      const Vec3 landing = find_landing(scene, pose.translation);
      least = least.cwiseMin(landing);
      most = most.cwiseMax(landing);
    }
  }
  if (least.x() > most.x()) return {};
  return {0.5 * (least + most), 0.5 * (most - least).norm()};
}

Viewpoint viewpoint_at(const scene::CameraEntry& camera, const Subject& subject, double time) {
  if (!camera.path.empty()) {
    const scene::CameraKey key = on_path(camera.path, time);
    return {key.position, key.target, key.fov};
  }
  const Vec3 target = camera.target.value_or(subject.centre);
  const double half_view = camera.fov * 3.14159265358979 / 360.0;
  const Vec3 away = Vec3(0.45, 0.35, 1.0).normalized() * (1.15 * subject.radius / std::sin(half_view));
  return {camera.position.value_or(target + away), target, camera.fov};
}

}  // namespace shatterbox::sandbox::view
