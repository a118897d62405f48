// What events can wait for instead of a time.
#pragma once

#include <optional>

#include "engine/world/world.h"
#include "sandbox/scene/event_description.h"

namespace shatterbox::sandbox::script {

class Conditions {
 public:
  /// Looks at the world before its coming step.
  void look(const world::World& world);

  /// The step border at which it came true for the first time; nothing if it has not.
  std::optional<long> since(scene::When when) const;

 private:
  std::optional<long> first_break_, rest_;
  std::optional<long> quiet_since_;  // step border from which on nobody has moved noticeably
};

}  // namespace shatterbox::sandbox::script
