#include "engine/geometry/solid_mesh.h"

#include <numeric>

namespace shatterbox::geometry {

SolidMesh make_solid_mesh(std::shared_ptr<const SolidElements> elements) {
  SolidMesh mesh;
  const TetMesh& tets = elements->mesh;
  mesh.vertex_source.resize(tets.positions.size());
  std::iota(mesh.vertex_source.begin(), mesh.vertex_source.end(), 0);
  mesh.cells.resize(tets.tetrahedra.size());
  for (std::size_t t = 0; t < tets.tetrahedra.size(); ++t) {
    mesh.cells[t].element = static_cast<int>(t);
    mesh.cells[t].vertices = tets.tetrahedra[t];
    mesh.cells[t].volume = tetrahedron_volume(tets, static_cast<int>(t));
  }
  mesh.elements = std::move(elements);
  return mesh;
}

double volume_fraction(const SolidMesh& mesh, const SolidCell& cell) {
  return cell.volume / tetrahedron_volume(mesh.elements->mesh, cell.element);
}

}  // namespace shatterbox::geometry
