// The kerf of a cut shell's surface: how its vertices stand back from crack faces without leaving the surface
// of the whole. For shell_surface.cpp.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "engine/core/vec.h"
#include "engine/geometry/triangle_mesh.h"

namespace shatterbox::geometry {

enum class BorderKind : std::uint8_t {
  crack,        // a new face
  older_crack,  // from which the whole stood back already: the vertex may not come nearer
  rim,          // of the whole shell: the vertex slides along it
};

/// What the border of a surface vertex asks of its kerf.
struct BorderNormal {
  int vertex;
  Vec3 inward;  // unit, in the cell's plane
  BorderKind kind;
  int element, side_id;
};

/// Moves the vertices of `mesh` back from their crack faces by `kerf` m (> 0) or, where the material is too
/// narrow for that, by less. A vertex stays in the planes of all its triangles: where two meet in a fold it
/// goes along the fold, so that a piece never sticks out of the whole that it was born from.
/// `triangle_normals` (|T|, unit) of the elements that the triangles lie in; `normals` ascending by vertex.
/// Returns the narrowest stand-off of a crack vertex that is not a tip, m; `kerf` without any.
/// A shift that leads a triangle's corner, or the middle of its side, where `is_within` (of a triangle and a
/// place, m) is false is halved too; it is not asked where it is empty.
double stand_back(TriangleMesh& mesh, const std::vector<Vec3>& triangle_normals,
                  const std::vector<BorderNormal>& normals, double kerf,
                  const std::function<bool(int, const Vec3&)>& is_within = {});

}  // namespace shatterbox::geometry
