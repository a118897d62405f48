// The body-centred cubic lattice about a closed surface. For tetrahedralise.cpp.
#pragma once

#include "engine/core/result.h"
#include "engine/geometry/tet_mesh.h"
#include "engine/geometry/triangle_mesh.h"

namespace shatterbox::geometry {

/// Tetrahedra of the lattice of cubes of `cell_size` m: all that could hold something of the inside of the
/// closed surface, also after vertices were moved by less than half a cell, and no farther ones than needed.
/// An error sentence if they were more than `most`.
core::Result<TetMesh> make_covering_lattice(const TriangleMesh& surface, double cell_size, int most);

}  // namespace shatterbox::geometry
