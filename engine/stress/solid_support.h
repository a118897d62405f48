// Which unknowns of a solid are clamped to the world.
#pragma once

#include <vector>

#include "engine/geometry/solid_mesh.h"

namespace shatterbox::stress {

/// Clamped unknowns, ascending: whole virtual vertices, or single axes on a plane of symmetry. Empty: free.
struct SolidSupport {
  std::vector<int> dofs;
  bool empty() const { return dofs.empty(); }
};

/// The support of a cut mesh, from the clamped vertices of its uncut elements (|V| flags). Of the cells of
/// one element those hold on to a clamped corner whose material lies nearest to it (by the weights of their
/// centroids): the others were cut off from it.
SolidSupport find_solid_support(const geometry::SolidMesh& mesh, const std::vector<char>& is_vertex_clamped);

}  // namespace shatterbox::stress
