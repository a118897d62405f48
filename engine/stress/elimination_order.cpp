#include "engine/stress/elimination_order.h"

#include <metis.h>

#include <algorithm>
#include <array>
#include <numeric>

#include "engine/core/index.h"
#include "engine/stress/metis_lock.h"

namespace shatterbox::stress {
namespace {

using Size = std::size_t;
using core::at;

}  // namespace

std::vector<int> rank_vertices(const geometry::ShellElements& elements) {
  return rank_vertices(elements.mesh.positions.size(), elements.topology.edges);
}

std::vector<int> rank_vertices(Size count, const std::vector<std::array<int, 2>>& edges) {
  std::vector<idx_t> first(count + 1, 0);
  for (const auto& edge : edges)
    for (const int vertex : edge) ++first[at(vertex) + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<idx_t> neighbours(at(first.back()));
  std::vector<idx_t> fill(first.begin(), first.end() - 1);
  for (const auto& edge : edges)
    for (Size end = 0; end < 2; ++end) neighbours[at(fill[at(edge[end])]++)] = edge[1 - end];

  std::vector<int> rank(count);
  std::iota(rank.begin(), rank.end(), 0);
  if (count < 3 || neighbours.empty()) return rank;
  std::array<idx_t, METIS_NOPTIONS> options{};
  idx_t vertex_count = static_cast<idx_t>(count);
  std::vector<idx_t> order(count);
  std::vector<idx_t> place(count);
  const std::lock_guard lock(metis_lock());
  METIS_SetDefaultOptions(options.data());
  options[METIS_OPTION_SEED] = 1;
  options[METIS_OPTION_NUMBERING] = 0;
  const int status = METIS_NodeND(&vertex_count, first.data(), neighbours.data(), nullptr, options.data(),
                                  order.data(), place.data());
  if (status == METIS_OK) std::copy(place.begin(), place.end(), rank.begin());
  return rank;
}

const std::vector<int>& SolidVertexRank::of(const geometry::SolidElements& elements) const {
  std::call_once(is_found_, [&] {
    std::vector<std::array<int, 2>> edges;
    edges.reserve(6 * elements.mesh.tetrahedra.size());
    for (const geometry::Tetrahedron& t : elements.mesh.tetrahedra)
      for (const auto& ends : geometry::kTetrahedronEdges) {
        const auto [low, high] = std::minmax(t[at(ends[0])], t[at(ends[1])]);
        edges.push_back({low, high});
      }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    rank_ = rank_vertices(elements.mesh.positions.size(), edges);
  });
  return rank_;
}

std::vector<int> order_nodes(const geometry::ShellMesh& mesh, const std::vector<int>& vertex_rank,
                             bool with_edges) {
  // A node's bucket is the place of its (first eliminated) source vertex; in it come edges before vertices,
  // edges by the place of their other end, copies by number.
  struct Node {
    int is_vertex, other_rank, id;
  };
  const Size vertex_count = mesh.vertex_source.size();
  const Size edge_count = with_edges ? mesh.edge_source.size() : 0;
  const auto edge_ranks = [&](Size edge) {
    const auto& ends = mesh.elements->topology.edges[at(mesh.edge_source[edge])];
    return std::minmax(vertex_rank[at(ends[0])], vertex_rank[at(ends[1])]);
  };
  std::vector<int> first(vertex_rank.size() + 1, 0);
  for (const int source : mesh.vertex_source) ++first[at(vertex_rank[at(source)]) + 1];
  for (Size edge = 0; edge < edge_count; ++edge) ++first[at(edge_ranks(edge).first) + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<Node> nodes(vertex_count + edge_count);
  std::vector<int> fill(first.begin(), first.end() - 1);
  for (Size edge = 0; edge < edge_count; ++edge) {
    const auto [low, high] = edge_ranks(edge);
    nodes[at(fill[at(low)]++)] = {0, high, static_cast<int>(vertex_count + edge)};
  }
  for (Size vertex = 0; vertex < vertex_count; ++vertex)
    nodes[at(fill[at(vertex_rank[at(mesh.vertex_source[vertex])])]++)] = {1, 0, static_cast<int>(vertex)};
  std::vector<int> order(nodes.size());
  for (Size bucket = 0; bucket + 1 < first.size(); ++bucket) {
    std::sort(
        nodes.begin() + first[bucket], nodes.begin() + first[bucket + 1], [](const Node& a, const Node& b) {
          return std::array{a.is_vertex, a.other_rank, a.id} < std::array{b.is_vertex, b.other_rank, b.id};
        });
  }
  std::transform(nodes.begin(), nodes.end(), order.begin(), [](const Node& node) { return node.id; });
  return order;
}

}  // namespace shatterbox::stress
