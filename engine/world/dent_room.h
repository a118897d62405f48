// How far a surface can change its shape before it meets somebody, or itself: its vertices go straight, all
// others stand.
#pragma once

#include <vector>

#include "engine/body/body.h"
#include "engine/core/vec.h"

namespace shatterbox::world {

/// A triangle mesh whose vertices go straight from `start` to `end` (world, m).
struct MovingSurface {
  std::vector<Vec3> start, end;  // |V|
  std::vector<geometry::Triangle> triangles;
};

struct Room {
  double share = 1.0;          // of its way, that a surface can go
  Vec3 normal = Vec3::Zero();  // unit, away from whom it meets first; zero if it meets nobody
  double approach = 0.0;       // m, that what meets him there would go towards him on all of its way
};

/// How far a surface can go and stay farther than `least_separation` m from `other`; or, where it is nearer
/// from the beginning, than half of what there is. No false negatives (continuous_tests.h).
Room find_room(const MovingSurface& surface, const body::Body& other, double least_separation);

/// The same of a surface and itself; what has a vertex in common does not count.
double own_free_share(const MovingSurface& surface, double least_separation);

}  // namespace shatterbox::world
