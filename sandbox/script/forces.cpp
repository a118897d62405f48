#include "sandbox/script/forces.h"

#include <algorithm>

#include "sandbox/scene/parts.h"

namespace shatterbox::sandbox::script {

namespace {

constexpr double kEarth = 9.81;          // m/s2
constexpr double kUsualStrength = 10.0;  // of a hand: times the weight of what it holds

/// Of what there is of a body, the part whose bounding ball is nearest to `point`, or the heaviest without
/// one; null if nothing can be held.
const body::Body* find_part(const scene::BuiltScene& built, scene::BodyRef who,
                            const std::optional<Vec3>& point) {
  const body::Body* best = nullptr;
  double best_value = 0.0;
  for (const body::Body* part : scene::parts_of(built, built.world.bodies(), who)) {
    if (!part->is_dynamic()) continue;
    const double value =
        point ? part->shape->bounding_radius - (*point - part->pose.translation).norm() : part->shape->mass;
    if (best != nullptr && value <= best_value) continue;
    best = part;
    best_value = value;
  }
  return best;
}

}  // namespace

Vec3 Forces::Way::at(double time) const {
  const double x = duration > 0.0 ? std::clamp((time - begin) / duration, 0.0, 1.0) : 1.0;
  return from + x * x * (3.0 - 2.0 * x) * (to - from);
}

std::string Forces::grab(const scene::Grab& grab, scene::BodyRef who, scene::BuiltScene& built) {
  if (held_.count(who) != 0) return "its body is held already";
  const body::Body* part = find_part(built, who, grab.point);
  if (part == nullptr) return "its body is not there, or cannot move";
  const Vec3 point = grab.point.value_or(part->pose.translation);
  const double force = grab.force.value_or(kUsualStrength * kEarth * part->shape->mass);
  held_[who] = {built.world.grab(part->id, point, force), point, std::nullopt};
  return {};
}

std::string Forces::carry(const scene::Carry& carry, scene::BodyRef who, const scene::BuiltScene& built) {
  const auto found = held_.find(who);
  if (found == held_.end()) return "no hand holds its body";
  found->second.way = Way{built.world.time(), carry.duration, found->second.place, carry.to};
  return {};
}

std::string Forces::release(scene::BodyRef who, scene::BuiltScene& built) {
  const auto found = held_.find(who);
  if (found == held_.end()) return "no hand holds its body";
  built.world.release(found->second.hand);
  held_.erase(found);
  return {};
}

void Forces::change(const scene::Gravity& gravity, const world::World& world) {
  gravity_ = Way{world.time(), gravity.ramp, world.settings().gravity, gravity.gravity};
}

void Forces::advance(world::World& world) {
  const double after = world.time() + 1.0 / world.settings().steps_per_second;
  if (gravity_) {
    world.set_gravity(gravity_->at(after));
    if (gravity_->is_over(after)) gravity_.reset();
  }
  for (auto held = held_.begin(); held != held_.end();) {
    if (held->second.way) held->second.place = held->second.way->at(after);
    const bool is_there = world.move_hand(held->second.hand, held->second.place);
    if (!is_there) world.release(held->second.hand);
    held = is_there ? std::next(held) : held_.erase(held);
  }
}

}  // namespace shatterbox::sandbox::script
