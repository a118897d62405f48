// In which order a shell's unknowns are eliminated. The vertices of the uncut elements are ordered once, by
// nested dissection (METIS); every piece keeps that order, copies beside their source, and each edge goes
// with the end that is eliminated first, so that a separator carries only the edges that lie in it. Ordering
// a third of the nodes once replaces ordering all unknowns at each break.
#pragma once

#include <array>
#include <mutex>
#include <vector>

#include "engine/geometry/shell_mesh.h"
#include "engine/geometry/solid_mesh.h"

namespace shatterbox::stress {

/// Place of each vertex in a nested dissection of the mesh (|V|, a permutation). Same mesh, same answer, any
/// thread.
std::vector<int> rank_vertices(const geometry::ShellElements& elements);

/// Likewise of any graph: `edges` (each once, no loops) between `vertex_count` vertices.
std::vector<int> rank_vertices(std::size_t vertex_count, const std::vector<std::array<int, 2>>& edges);

/// The same of a solid's elements (|V|), found when it is first asked for and then kept: only cracks ask.
class SolidVertexRank {
 public:
  /// Any thread; `elements` are always the same ones.
  const std::vector<int>& of(const geometry::SolidElements& elements) const;

 private:
  mutable std::once_flag is_found_;
  mutable std::vector<int> rank_;
};

/// The nodes of a (cut) mesh in elimination order: virtual vertex v is node v, virtual edge e is node
/// |virtual vertices| + e. Edges are left out if `with_edges` is false.
std::vector<int> order_nodes(const geometry::ShellMesh& mesh, const std::vector<int>& vertex_rank,
                             bool with_edges);

}  // namespace shatterbox::stress
