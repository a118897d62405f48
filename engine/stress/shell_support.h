// Which unknowns of a shell are clamped to the world.
#pragma once

#include <vector>

#include "engine/geometry/shell_mesh.h"

namespace shatterbox::stress {

/// Virtual vertices (all three displacements) and virtual edges (rotation) that are clamped; ascending.
/// Empty: free.
struct ShellSupport {
  std::vector<int> vertices;
  std::vector<int> edges;
  bool empty() const { return vertices.empty() && edges.empty(); }
};

/// The support of a cut mesh, from the clamped vertices and edges of its uncut elements (|V| and |E| flags):
/// a copy is clamped only where its own material reaches the clamped vertex or edge. Two clamped vertices
/// clamp the line between them if it is an edge; the rotation about it stays free unless the edge is clamped
/// too.
ShellSupport find_support(const geometry::ShellMesh& mesh, const std::vector<char>& is_vertex_clamped,
                          const std::vector<char>& is_edge_clamped);

}  // namespace shatterbox::stress
