#include "engine/stress/shell_figures.h"

#include "engine/geometry/shell_surface.h"
#include "engine/stress/shell_load.h"
#include "engine/stress/stress_bound.h"

namespace shatterbox::stress {

ShellFigures make_shell_figures(const ShellStiffness& stiffness, const geometry::ShellMesh& mesh) {
  ShellFigures figures;
  figures.contacts = find_cell_contacts(mesh);
  figures.lumped_mass = lumped_mass(stiffness, mesh);
  figures.mass = shell_mass_properties(mesh, stiffness.properties.thickness, stiffness.properties.density);
  const auto& positions = mesh.elements->mesh.positions;
  if (!positions.empty()) {
    Vec3 low = positions.front(), high = low;
    for (const Vec3& p : positions) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    figures.size = (high - low).maxCoeff();
  }
  if (!mesh.cells.empty()) {
    Vec3 low = Vec3::Constant(1e300), high = -low;
    for (const geometry::ShellCell& cell : mesh.cells)
      for (const int vertex : mesh.elements->mesh.triangles[static_cast<std::size_t>(cell.element)]) {
        const Vec3& p = positions[static_cast<std::size_t>(vertex)];
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
      }
    figures.reach = (high - low).norm();
  }
  figures.mean_edge_length = mean_edge_length(mesh);
  figures.stressed_areas = stressed_areas(mesh, figures.contacts);
  return figures;
}

}  // namespace shatterbox::stress
