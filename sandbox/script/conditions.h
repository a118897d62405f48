// What events can wait for instead of a time.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "sandbox/scene/build_world.h"

namespace shatterbox::sandbox::script {

class Conditions {
 public:
  /// Looks at the world before its coming step.
  void look(const scene::BuiltScene& built);

  /// The step border at which what the event waits for came true for the first time; nothing if it has not.
  std::optional<long> since(const scene::EventEntry& event) const;

 private:
  void look_for_breaks(const scene::BuiltScene& built);

  struct FirstBreak {
    scene::Origin whose;
    long step = 0;
  };
  std::vector<FirstBreak> first_breaks_;  // of each original body that broke, ascending in steps
  std::size_t breaks_seen_ = 0;
  std::optional<long> rest_;
  std::optional<long> quiet_since_;  // step border from which on nobody has moved noticeably
};

}  // namespace shatterbox::sandbox::script
