// Whether what events throw hits anything.
#pragma once

#include <string>
#include <vector>

#include "engine/world/world.h"
#include "sandbox/script/script.h"

namespace shatterbox::sandbox::run {

class Throws {
 public:
  /// What came in before the coming step.
  void add(const std::vector<script::Throw>& thrown);
  /// After a step.
  void look(const world::World& world);
  /// At the end, at `time` (s): a sentence for each that met nothing but floors.
  std::vector<std::string> missed(double time) const;

 private:
  struct Flight {
    script::Throw thrown;
    bool has_hit_floor = false;
  };
  std::vector<Flight> flights_;  // that have hit nothing yet
};

}  // namespace shatterbox::sandbox::run
