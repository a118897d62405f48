#include "engine/stress/shell_support.h"

#include <array>

#include "engine/core/index.h"

namespace shatterbox::stress {
namespace {

using Size = std::size_t;
using core::at;

std::vector<int> list_flags(const std::vector<char>& flags) {
  std::vector<int> list;
  for (Size i = 0; i < flags.size(); ++i)
    if (flags[i] != 0) list.push_back(static_cast<int>(i));
  return list;
}

}  // namespace

ShellSupport find_support(const geometry::ShellMesh& mesh, const std::vector<char>& is_vertex_clamped,
                          const std::vector<char>& is_edge_clamped) {
  constexpr double kCorner = 1e-9;  // of barycentric weights: the polygon has the element's corner
  const geometry::ShellElements& elements = *mesh.elements;
  std::vector<char> vertices(mesh.vertex_source.size(), 0);
  std::vector<char> edges(mesh.edge_source.size(), 0);
  for (const geometry::ShellCell& cell : mesh.cells) {
    const geometry::Triangle& triangle = elements.mesh.triangles[at(cell.element)];
    const auto& triangle_edges = elements.topology.triangle_edges[at(cell.element)];
    for (int c = 0; c < cell.corner_count; ++c) {
      const geometry::ShellCorner& corner = mesh.corners[at(cell.first_corner + c)];
      const Vec2& b = corner.barycentric;
      const std::array<double, 3> weights{1.0 - b.x() - b.y(), b.x(), b.y()};
      for (Size i = 0; i < 3; ++i)
        if (weights[i] > 1.0 - kCorner && is_vertex_clamped[at(triangle[i])] != 0)
          vertices[at(cell.vertices[i])] = 1;
      if (corner.side != geometry::SideKind::element_edge) continue;
      const Size i = at(corner.side_id);
      const Size j = (i + 1) % 3;
      if (is_vertex_clamped[at(triangle[i])] == 0 || is_vertex_clamped[at(triangle[j])] == 0) continue;
      vertices[at(cell.vertices[i])] = vertices[at(cell.vertices[j])] = 1;
      if (is_edge_clamped[at(triangle_edges[i])] != 0) edges[at(cell.edges[i])] = 1;
    }
  }
  return {list_flags(vertices), list_flags(edges)};
}

}  // namespace shatterbox::stress
