// Pairs of bodies whose swept bounds overlap, by sort and sweep.
#pragma once

#include <vector>

#include "engine/geometry/bvh.h"

namespace shatterbox::collision {

struct SweptBound {
  geometry::Box box;       // of the whole step's motion, margins included
  bool is_moving = false;  // two bodies that do not move are no pair
};

struct IndexPair {
  int a = 0, b = 0;  // a < b
};

/// Pairs (a, b) of overlapping bounds (|bodies|), ascending. Empty boxes meet nobody.
std::vector<IndexPair> find_overlapping_pairs(const std::vector<SweptBound>& bounds);

}  // namespace shatterbox::collision
