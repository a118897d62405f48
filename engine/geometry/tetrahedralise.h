// From a closed surface to a solid: well-shaped tetrahedra that cover it, and the material in each of them.
// The given surface stays the solid's surface (embedded): the tetrahedra reach a little beyond it.
#pragma once

#include <memory>

#include "engine/core/result.h"
#include "engine/geometry/embedded_material.h"
#include "engine/geometry/tet_quality.h"

namespace shatterbox::geometry {

/// So many times as large as at the surface can tetrahedra become inside: 1, 2, 4 or 8.
constexpr bool is_grading(int times) {
  return times == 1 || times == 2 || times == 4 || times == 8;
}

struct TetrahedraOptions {
  double element_size =
      0.0;            // m: side of the lattice's cubes, of which a tetrahedron's edges are 0.87 to 1; or
  int count = 0;      // about how many tetrahedra (used if element_size is 0)
  int grading = 1;    // is_grading: so many times as large they become inside
  bool warps = true;  // vertices near the surface are moved to it; false: the lattice as it is
};

/// The element size that tetrahedralise() takes for a surface, m.
double element_size_for(const TriangleMesh& surface, const TetrahedraOptions& options);

struct EmbeddedSolid {
  std::shared_ptr<const SolidElements> elements;
  EmbeddedMaterial embedded;
  double element_size = 0.0;  // m
  TetQuality quality;
  double cover_ratio = 0.0;  // volume of the elements over that of the material
};

/// Tetrahedra of a body-centred cubic lattice about `surface` (closed, wound counter-clockwise seen from
/// outside, not crossing itself; diagnose_solid). Vertices near the surface are moved to just outside of it,
/// as in [LS07], as far as no tetrahedron gets an angle below 25 or above 140 degrees; but no tetrahedron is
/// cut or left out that holds some of the inside, so every point of the solid lies in one. Graded, the
/// tetrahedra at the surface are those of the even lattice. The same surface gives the same bits.
core::Result<EmbeddedSolid> tetrahedralise(const TriangleMesh& surface, const TetrahedraOptions& options);

}  // namespace shatterbox::geometry
