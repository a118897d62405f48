// One place where two bodies touch or may soon touch, as the solver wants it.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/core/vec.h"

namespace shatterbox::collision {

struct Contact {
  std::uint64_t key = 0;           // names both features within the pair: the same from step to step
  Vec3 on_a = Vec3::Zero();        // m, world, material point of a at the start of the step
  Vec3 on_b = Vec3::Zero();        // m, world, material point of b at the start of the step
  Vec3 normal = Vec3::UnitY();     // unit, from b towards a
  double gap = 0.0;                // m, along the normal at the start of the step
  double lean = 0.5;               // where impulses act: 1 at a's point, 0 at b's, as the bodies slide apart
  bool is_time_of_impact = false;  // found on the path, not at its start
};

/// Keeps few contacts that stand for all: those in `loaded_keys` (ascending) first while they are within
/// `loaded_reach` (m), so that what rests keeps its feet; then nearest first, none within `radius` of a kept
/// one that points the same way, at most `cap`. The order of the result is by key.
void reduce_manifold(std::vector<Contact>& contacts, const std::vector<std::uint64_t>& loaded_keys,
                     double loaded_reach, double radius, std::size_t cap);

}  // namespace shatterbox::collision
