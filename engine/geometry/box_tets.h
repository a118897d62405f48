// Boxes of tetrahedra: the body-centred cubic lattice, cut off at the box's faces. For bricks, walls, slabs,
// dominoes.
#pragma once

#include "engine/core/result.h"
#include "engine/core/vec.h"
#include "engine/geometry/tet_mesh.h"

namespace shatterbox::geometry {

inline constexpr int kMostTetrahedra = 8'000'000;

/// The box of `half_extent` (m) about the origin, filled exactly. Its border is flat to the bit. Cells of the
/// lattice are as near to cubes of `element_size` (m) as fits the box, and never much flatter than 2 : 1: a
/// thin plate gets smaller elements than it was asked for. 12 tetrahedra a cell inside; a cell's face on the
/// border is divided in four about its middle. In cubes all dihedral angles are from 45 to 90 degrees.
///
/// Beside the other ways of dividing cubes: Kuhn's six tetrahedra have angles from 45 to 90 degrees too, but
/// all their diagonals lean one way (the edges' directions have second moments 1 : 2.7 across and along it);
/// five alternating ones have 54.7 to 90 and do not lean, but vertices with 6 and with 18 edges by turns, and
/// sizes 1 : 2. The lattice's are all alike, each vertex has 14 edges, and the mesh is its own mirror image
/// in all three axes.
///
/// An error sentence if a size makes no sense or more than kMostTetrahedra would come out.
core::Result<TetMesh> make_box_tets(const Vec3& half_extent, double element_size);

}  // namespace shatterbox::geometry
