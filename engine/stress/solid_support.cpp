#include "engine/stress/solid_support.h"

#include <array>

#include "engine/core/index.h"
#include "engine/stress/solid_stiffness.h"

namespace shatterbox::stress {

using core::at;

SolidSupport find_solid_support(const geometry::SolidMesh& mesh, const std::vector<char>& is_vertex_clamped) {
  const geometry::TetMesh& tets = mesh.elements->mesh;
  std::vector<std::array<double, 4>> nearest(tets.tetrahedra.size(), {-1.0, -1.0, -1.0, -1.0});
  const auto weights_of = [](const geometry::SolidCell& cell) { return centroid_weights(cell); };
  for (const geometry::SolidCell& cell : mesh.cells)
    for (int i = 0; i < 4; ++i) {
      double& most = nearest[at(cell.element)][at(i)];
      most = std::max(most, weights_of(cell)(i));
    }
  std::vector<char> is_clamped(mesh.vertex_source.size(), 0);
  for (const geometry::SolidCell& cell : mesh.cells)
    for (int i = 0; i < 4; ++i)
      if (is_vertex_clamped[at(tets.tetrahedra[at(cell.element)][at(i)])] != 0 &&
          weights_of(cell)(i) >= nearest[at(cell.element)][at(i)])
        is_clamped[at(cell.vertices[at(i)])] = 1;
  SolidSupport support;
  for (std::size_t v = 0; v < is_clamped.size(); ++v)
    for (int axis = 0; axis < 3 && is_clamped[v] != 0; ++axis)
      support.dofs.push_back(3 * static_cast<int>(v) + axis);
  return support;
}

}  // namespace shatterbox::stress
