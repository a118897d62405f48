// Does a surface pass through itself?
#pragma once

#include "engine/geometry/triangle_mesh.h"

namespace shatterbox::geometry {

struct SelfCrossings {
  int count = 0;                                  // pairs of triangles that pass through each other
  int first_triangle = -1, second_triangle = -1;  // the first such pair; -1 without any
  Vec3 place = Vec3::Zero();                      // where it does, m
};

/// Pairs of triangles of which a side of one passes through the inside of the other, exactly; what only
/// touches does not count. Neighbours over a vertex may cross too, neighbours over an edge cannot.
SelfCrossings find_self_crossings(const TriangleMesh& mesh);

}  // namespace shatterbox::geometry
