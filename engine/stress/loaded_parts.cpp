#include "engine/stress/loaded_parts.h"

#include <algorithm>

#include "engine/core/index.h"
#include "engine/stress/shell_stiffness.h"

namespace shatterbox::stress {

using core::at;

core::DisjointSets parts_of(const geometry::ShellMesh& mesh) {
  core::DisjointSets parts(mesh.vertex_source.size());
  for (const geometry::ShellCell& cell : mesh.cells)
    for (const int vertex : cell.vertices) parts.unite(vertex, cell.vertices[0]);
  return parts;
}

std::vector<int> part_of_dofs(const geometry::ShellMesh& mesh) {
  core::DisjointSets parts = parts_of(mesh);
  std::vector<char> is_used(mesh.vertex_source.size(), 0);
  for (const geometry::ShellCell& cell : mesh.cells)
    for (const int vertex : cell.vertices) is_used[at(vertex)] = 1;
  std::vector<int> part_of(at(mesh.degree_of_freedom_count()), -1);
  std::vector<int> number(is_used.size(), -1);
  int count = 0;
  for (int v = 0; v < static_cast<int>(is_used.size()); ++v) {
    if (is_used[at(v)] == 0) continue;
    int& part = number[at(parts.find(v))];
    if (part < 0) part = count++;
    for (int axis = 0; axis < 3; ++axis) part_of[at(vertex_dof(v) + axis)] = part;
  }
  for (const geometry::ShellCell& cell : mesh.cells)
    for (const int edge : cell.edges)
      part_of[at(edge_dof(mesh, edge))] = part_of[at(vertex_dof(cell.vertices[0]))];
  return part_of;
}

geometry::ShellMesh loaded_parts(const geometry::ShellMesh& mesh, const std::vector<const VecX*>& loads) {
  core::DisjointSets parts = parts_of(mesh);
  std::vector<char> is_loaded(mesh.vertex_source.size(), 0);
  const auto is_on = [&](int dof) {
    return std::any_of(loads.begin(), loads.end(), [&](const VecX* load) { return (*load)(dof) != 0.0; });
  };
  for (const geometry::ShellCell& cell : mesh.cells) {
    char& mark = is_loaded[at(parts.find(cell.vertices[0]))];
    const auto dofs = cell_dofs(mesh, cell);
    if (mark == 0 && std::any_of(dofs.begin(), dofs.end(), is_on)) mark = 1;
  }
  geometry::ShellMesh loaded = mesh;
  std::erase_if(loaded.cells, [&](const geometry::ShellCell& cell) {
    return is_loaded[at(parts.find(cell.vertices[0]))] == 0;
  });
  return loaded;
}

}  // namespace shatterbox::stress
