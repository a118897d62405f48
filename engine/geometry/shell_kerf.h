// The kerf of a cut shell's surface: how its vertices stand back from crack faces without leaving the surface
// of the whole. For shell_surface.cpp.
#pragma once

#include <vector>

#include "engine/core/vec.h"
#include "engine/geometry/triangle_mesh.h"

namespace shatterbox::geometry {

/// What the border of a surface vertex asks of its kerf.
struct BorderNormal {
  int vertex;
  Vec3 inward;    // unit, in the cell's plane
  bool is_crack;  // false: the rim of the whole shell, along which the vertex slides
  int element, side_id;
};

/// Moves the vertices of `mesh` back from their crack faces by `kerf` m (> 0) or, where the material is too
/// narrow for that, by less. A vertex stays in the planes of all its triangles: where two meet in a fold it
/// goes along the fold, so that a piece never sticks out of the whole that it was born from.
/// `triangle_normals` (|T|, unit) of the elements that the triangles lie in; `normals` ascending by vertex.
/// Returns the narrowest stand-off of a crack vertex that is not a tip, m; `kerf` without any.
double stand_back(TriangleMesh& mesh, const std::vector<Vec3>& triangle_normals,
                  const std::vector<BorderNormal>& normals, double kerf);

}  // namespace shatterbox::geometry
