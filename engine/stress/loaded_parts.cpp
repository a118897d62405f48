#include "engine/stress/loaded_parts.h"

#include <algorithm>
#include <numeric>

#include "engine/core/index.h"
#include "engine/stress/shell_stiffness.h"

namespace shatterbox::stress {
namespace {

using Size = std::size_t;
using core::at;

int find_first(std::vector<int>& parent, int i) {
  while (parent[at(i)] != i) i = parent[at(i)] = parent[at(parent[at(i)])];
  return i;
}

}  // namespace

geometry::ShellMesh loaded_parts(const geometry::ShellMesh& mesh, const std::vector<const VecX*>& loads) {
  std::vector<int> parent(mesh.vertex_source.size());
  std::iota(parent.begin(), parent.end(), 0);
  for (const geometry::ShellCell& cell : mesh.cells)
    for (const int vertex : cell.vertices) {
      const int a = find_first(parent, vertex);
      const int b = find_first(parent, cell.vertices[0]);
      parent[at(std::max(a, b))] = std::min(a, b);
    }
  std::vector<char> is_loaded(parent.size(), 0);
  const auto is_on = [&](int dof) {
    return std::any_of(loads.begin(), loads.end(), [&](const VecX* load) { return (*load)(dof) != 0.0; });
  };
  for (const geometry::ShellCell& cell : mesh.cells) {
    char& mark = is_loaded[at(find_first(parent, cell.vertices[0]))];
    const auto dofs = cell_dofs(mesh, cell);
    if (mark == 0 && std::any_of(dofs.begin(), dofs.end(), is_on)) mark = 1;
  }
  geometry::ShellMesh loaded = mesh;
  std::erase_if(loaded.cells, [&](const geometry::ShellCell& cell) {
    return is_loaded[at(find_first(parent, cell.vertices[0]))] == 0;
  });
  return loaded;
}

}  // namespace shatterbox::stress
