// Triangles without area, and how to be rid of them without opening a slit in the surface.
#pragma once

#include <vector>

#include "engine/geometry/triangle_mesh.h"

namespace shatterbox::geometry {

/// Height of a triangle over its longest edge: 0.87 if it is equilateral, 0 if it has no area. Safe for any
/// size.
double flatness(const TriangleMesh& mesh, const Triangle& triangle);

struct FlatTriangles {
  int count = 0;   // how many went
  int first = -1;  // source of the first one
};

/// Removes triangles whose flatness is below 1e-12. Where one has two corners at (almost) one place, they
/// become one; where one corner lies on the opposite edge, the triangle across that edge is divided there.
/// `source` is per triangle and follows; vertices are left, used or not.
FlatTriangles remove_flat_triangles(TriangleMesh& mesh, std::vector<int>& source);

}  // namespace shatterbox::geometry
