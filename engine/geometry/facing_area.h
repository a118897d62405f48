// Where two surfaces face each other closely: the area that a layer of mortar between them would have, with
// its moments.
#pragma once

#include <vector>

#include "engine/core/vec.h"
#include "engine/geometry/triangle_mesh.h"

namespace shatterbox::geometry {

/// A plane area (of a bent one, the plane in its mean).
struct FacingArea {
  double area = 0.0;             // m2; 0: they do not face each other so closely
  Vec3 centre = Vec3::Zero();    // m, midway between both surfaces
  Mat3 axes = Mat3::Identity();  // columns: from b towards a, and the principal axes of the area
  Vec2 moments =
      Vec2::Zero();           // m4: of the squares of the distances from the second axis, and from the third
  std::vector<Vec2> outline;  // m, convex, along the second and the third axis from the centre
};

/// Of triangles that look against each other to within a degree, what is no further apart than `gap` (m).
/// Both meshes in one space, wound so that they look outwards.
FacingArea find_facing_area(const TriangleMesh& a, const TriangleMesh& b, double gap);

}  // namespace shatterbox::geometry
