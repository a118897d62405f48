#include "sandbox/script/conditions.h"

#include <algorithm>

#include "engine/dynamics/rest.h"
#include "sandbox/scene/parts.h"

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

void Conditions::look_for_breaks(const scene::BuiltScene& built) {
  const std::vector<world::BreakRow>& breaks = built.world.report().breaks;
  for (; breaks_seen_ < breaks.size(); ++breaks_seen_) {
    const scene::Origin* found = scene::origin_of(built, breaks[breaks_seen_].id);
    if (found == nullptr) continue;
    const scene::Origin& whose = *found;
    const bool is_known =
        std::any_of(first_breaks_.begin(), first_breaks_.end(), [&](const FirstBreak& first) {
          return first.whose.entry == whose.entry && first.whose.copy == whose.copy;
        });
    if (!is_known) first_breaks_.push_back({whose, built.world.steps()});
  }
}

void Conditions::look(const scene::BuiltScene& built) {
  const world::World& world = built.world;
  const long now = world.steps();
  look_for_breaks(built);
  if (rest_) return;
  if (!is_quiet(world)) {
    quiet_since_.reset();
    return;
  }
  if (!quiet_since_) quiet_since_ = now;
  if (static_cast<double>(now - *quiet_since_) >= scene::kRestTime * world.settings().steps_per_second)
    rest_ = now;
}

std::optional<long> Conditions::since(const scene::EventEntry& event) const {
  if (event.when == scene::When::time) return 0;
  if (event.when == scene::When::rest) return rest_;
  const auto first = std::find_if(first_breaks_.begin(), first_breaks_.end(), [&](const FirstBreak& one) {
    return event.whose.body < 0 || event.whose.includes(one.whose.entry, one.whose.copy);
  });
  return first == first_breaks_.end() ? std::nullopt : std::optional<long>(first->step);
}

}  // namespace shatterbox::sandbox::script
