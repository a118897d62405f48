// A cracked solid on elements of its own: what the virtual node algorithm [MBF04] copies for the stress
// becomes elements and vertices, so that what lies on one side of a crack can move without the other.
#pragma once

#include <array>
#include <vector>

#include "engine/geometry/solid_complex.h"

namespace shatterbox::geometry {

struct CopiedSolid {
  SolidComplex complex;              // settled; cells of the same numbers; the elements have no topology
  std::vector<int> element_sources;  // |elements|: the element that each is a copy of
  std::vector<int> vertex_sources;   // |vertices of the element mesh|: that each is a copy of
  /// Facets of open cracks, behind and in front; corner for corner they were one.
  std::vector<std::array<int, 2>> lips;
};

/// `piece` (settled) with the degrees of freedom of `mesh`, its own (make_solid_mesh): each connected part of
/// an element's material gets a copy of the element, and open cracks are border on both of their sides. What
/// of a crack no vertex can open is closed: a boundary that holds.
CopiedSolid copy_elements(const SolidComplex& piece, const SolidMesh& mesh);

}  // namespace shatterbox::geometry
