#include "sandbox/view/ways.h"

#include <algorithm>

#include "engine/body/scripted_path.h"
#include "engine/core/elementary.h"

namespace shatterbox::sandbox::view {
namespace {

constexpr int kLooks = 16;  // from key to key, in a turn, on a way of its own size

}  // namespace

void append(std::span<const Vec3> corners, std::vector<Vec3>& all) {
  all.insert(all.end(), corners.begin(), corners.end());
}

Corners corners_of(const geometry::Box& box, const Pose& pose) {
  Corners corners;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3 corner((i & 1) != 0 ? box.high.x() : box.low.x(), (i & 2) != 0 ? box.high.y() : box.low.y(),
                      (i & 4) != 0 ? box.high.z() : box.low.z());
    corners[i] = pose.apply(corner);
  }
  return corners;
}

geometry::Box box_about(std::span<const Vec3> points) {
  geometry::Box box;
  for (const Vec3& p : points) box.include(p);
  return box;
}

geometry::Box room_about(const geometry::Box& box, double share) {
  const Vec3 room = Vec3::Constant(share * (box.high - box.low).maxCoeff());
  return {box.low - room, box.high + room};
}

std::vector<Vec3> corners_on_path(const scene::BodyEntry& body, const scene::BodyPlan& plan, const Pose& pose,
                                  double seconds) {
  const world::PathDescription own = scene::path_of(body, pose);
  const body::ScriptedPath path(own.keys, own.between, own.turn, -own.pivot);
  std::vector<Vec3> corners;
  double from = 0.0;
  for (const body::Keyframe& key : own.keys) {
    const double to = std::min(key.time, seconds);
    for (int k = 0; k <= kLooks; ++k)
      append(corners_of(plan.box, path.pose_at(from + (to - from) * k / kLooks)), corners);
    from = to;
  }
  return corners;
}

bool is_on_axle(const scene::BodyEntry& body) {
  return body.motion == body::Motion::dynamic && body.locked.let_move(Vec3::Ones()).isZero(0.0) &&
         body.locked.count_turns() > 0;
}

std::vector<Vec3> corners_on_axle(const scene::BodyEntry& body, const scene::BodyPlan& plan,
                                  const Pose& pose) {
  std::vector<Vec3> corners;
  const Vec3 centre = pose.apply(plan.centre);
  if (body.locked.count_turns() > 1) {
    const Vec3 reach = Vec3::Constant(plan.reach);
    append(corners_of({-reach, reach}, Pose{Quat::Identity(), centre}), corners);
    return corners;
  }
  const Vec3 axis = body.locked.let_turn(Vec3::Ones());
  for (int k = 0; k < kLooks; ++k) {
    const double half = core::kPi * k / kLooks;
    const Vec3 sine = core::sin(half) * axis;
    const Quat turn(core::cos(half), sine.x(), sine.y(), sine.z());
    append(corners_of(plan.box, Pose{turn * pose.rotation, centre + turn * (pose.translation - centre)}),
           corners);
  }
  return corners;
}

std::optional<Vec3> find_meeting(const geometry::Box& flying, const Vec3& velocity, const Vec3& gravity,
                                 const std::vector<geometry::Box>& others, double seconds) {
  const auto way_at = [&](double time) { return Vec3(time * velocity + 0.5 * time * time * gravity); };
  const auto moved = [&](const Vec3& way) { return geometry::Box{flying.low + way, flying.high + way}; };
  geometry::Box swept = flying;
  // It is highest, or lowest, between the looks by less than its size.
  const double size = std::max((flying.high - flying.low).norm(), 1e-9);
  const double length = (velocity.norm() + 0.5 * seconds * gravity.norm()) * seconds;
  const int looks = std::clamp(static_cast<int>(kLooks * length / size), kLooks, 100 * kLooks);
  for (int k = 1; k <= looks; ++k) {
    const geometry::Box box = moved(way_at(seconds * k / looks));
    swept.include(box.low);
    swept.include(box.high);
  }
  std::vector<geometry::Box> near;
  for (const geometry::Box& other : others)
    if (geometry::overlaps(swept, other) && !geometry::overlaps(flying, other)) near.push_back(other);
  for (int k = 1; k <= looks && !near.empty(); ++k) {
    const Vec3 way = way_at(seconds * k / looks);
    const geometry::Box box = moved(way);
    if (std::any_of(near.begin(), near.end(), [&](const auto& other) { return overlaps(box, other); }))
      return way;
  }
  return std::nullopt;
}

}  // namespace shatterbox::sandbox::view
