#include "sandbox/script/conditions.h"

#include <algorithm>

#include "engine/dynamics/rest.h"

namespace shatterbox::sandbox::script {

namespace {

/// Whether there is something that can move, and none of it does.
bool is_quiet(const world::World& world) {
  dynamics::ContactSettings settings;
  settings.time_step = 1.0 / world.settings().steps_per_second;
  settings.gravity = world.settings().gravity;
  bool can_move = false;
  for (const body::Body& b : world.bodies()) {
    if (!b.is_dynamic()) continue;
    can_move = true;
    if (b.is_awake && !dynamics::is_quiet(settings, b.velocity, b.angular_velocity, b.shape->bounding_radius))
      return false;
  }
  return can_move;
}

}  // namespace

void Conditions::look(const world::World& world) {
  const long now = world.steps();
  if (!first_break_ && !world.report().breaks.empty()) first_break_ = now;
  if (rest_) return;
  if (!is_quiet(world)) {
    quiet_since_.reset();
    return;
  }
  if (!quiet_since_) quiet_since_ = now;
  if (static_cast<double>(now - *quiet_since_) >= scene::kRestTime * world.settings().steps_per_second)
    rest_ = now;
}

std::optional<long> Conditions::since(scene::When when) const {
  if (when == scene::When::time) return 0;
  return when == scene::When::rest ? rest_ : first_break_;
}

}  // namespace shatterbox::sandbox::script
