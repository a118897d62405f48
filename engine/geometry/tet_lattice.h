// The body-centred cubic lattice about a closed surface. For tetrahedralise.cpp.
#pragma once

#include "engine/core/result.h"
#include "engine/geometry/tet_mesh.h"
#include "engine/geometry/triangle_mesh.h"

namespace shatterbox::geometry {

/// How many cubes must lie between a large one, of 2^level along each edge, and the nearest that a triangle
/// may touch: so many that large ones that share an edge differ by one level at most.
constexpr int least_depth(int level) {
  return (2 << level) - 2;
}

/// Tetrahedra of the lattice of cubes of `cell_size` m: all that could hold something of the inside of the
/// closed surface, also after vertices were moved by less than half a cell, and no farther ones than needed.
/// Inside they become up to `grading` times (1, 2, 4 or 8) as large. An error sentence if they were more than
/// `most`.
core::Result<TetMesh> make_covering_lattice(const TriangleMesh& surface, double cell_size, int grading,
                                            int most);

}  // namespace shatterbox::geometry
