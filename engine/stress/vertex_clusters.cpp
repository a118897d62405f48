#include "engine/stress/vertex_clusters.h"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <utility>

#include "engine/core/disjoint_sets.h"
#include "engine/core/elementary.h"
#include "engine/core/index.h"

namespace shatterbox::stress {
namespace {

using Size = std::size_t;
using core::at;

constexpr double kOfTies = 1.0 - 1e-9;  // a pull that is greater by less than rounding is not greater
constexpr double kWeak = 0.03;          // share of both ends' stiffness below which an edge joins nothing
constexpr int kLeastVertices = 4;       // of a cluster
constexpr int kRoundsOfJoining = 8;

double block_trace(const BlockRows& rows, int block) {
  const double* const e = &rows.entries[9 * at(block)];
  return std::abs(e[0]) + std::abs(e[4]) + std::abs(e[8]);
}

/// Share of both ends' own stiffness that a block couples.
double coupling(const BlockRows& rows, Size v, int block) {
  const Size w = at(rows.column[at(block)]);
  const double both = core::sqrt(block_trace(rows, rows.first[v]) * block_trace(rows, rows.first[w]));
  return both > 0.0 ? block_trace(rows, block) / both : 0.0;
}

/// Clusters and what couples them.
struct ClusterGraph {
  std::vector<int> size;          // vertices of each
  std::vector<int> first, other;  // neighbours of cluster c: [first[c], first[c + 1])
  std::vector<double> weight;     // likewise: sum of the couplings

  int count() const { return static_cast<int>(size.size()); }
};

/// Every vertex with stiffness by itself; `cluster` (|V|) says which it is.
ClusterGraph single_vertices(const BlockRows& rows, std::vector<int>& cluster) {
  ClusterGraph graph;
  cluster.assign(rows.size(), -1);
  for (Size v = 0; v < rows.size(); ++v)
    if (rows.first[v] < rows.first[v + 1]) {
      cluster[v] = graph.count();
      graph.size.push_back(1);
    }
  graph.first.push_back(0);
  for (Size v = 0; v < rows.size(); ++v) {
    if (cluster[v] < 0) continue;
    for (int b = rows.first[v] + 1; b < rows.first[v + 1]; ++b) {
      graph.other.push_back(cluster[at(rows.column[at(b)])]);
      graph.weight.push_back(coupling(rows, v, b));
    }
    graph.first.push_back(static_cast<int>(graph.other.size()));
  }
  return graph;
}

/// Who joins whom: each cluster, the small ones first, takes the neighbour that it is coupled to most for its
/// size, if that is still alone and both together are not above `most` vertices. The new number of each.
std::vector<int> match(const ClusterGraph& graph, int most, int& count) {
  std::vector<int> order(graph.size.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return graph.size[at(a)] < graph.size[at(b)]; });
  std::vector<int> number(graph.size.size(), -1);
  count = 0;
  for (const int c : order) {
    if (number[at(c)] >= 0) continue;
    int best = -1;
    double greatest = 0.0;
    for (int k = graph.first[at(c)]; k < graph.first[at(c) + 1]; ++k) {
      const int other = graph.other[at(k)];
      if (number[at(other)] >= 0 || graph.size[at(c)] + graph.size[at(other)] > most) continue;
      const double size = graph.size[at(other)];
      const double pull = graph.weight[at(k)] / (size * size);  // small ones first: fewest iterations
      if (pull * kOfTies > greatest) {
        best = other;
        greatest = pull;
      }
    }
    number[at(c)] = count;
    if (best >= 0) number[at(best)] = count;
    ++count;
  }
  return number;
}

ClusterGraph joined(const ClusterGraph& graph, const std::vector<int>& number, int count) {
  std::vector<std::array<int, 2>> members(at(count), {-1, -1});
  for (int c = 0; c < graph.count(); ++c) {
    auto& own = members[at(number[at(c)])];
    own[own[0] < 0 ? 0 : 1] = c;
  }
  ClusterGraph result;
  result.first.push_back(0);
  std::vector<int> place(at(count), -1);  // of a neighbour among those of the present cluster
  for (int c = 0; c < count; ++c) {
    const int begin = result.first.back();
    int size = 0;
    for (const int member : members[at(c)]) {
      if (member < 0) continue;
      size += graph.size[at(member)];
      for (int k = graph.first[at(member)]; k < graph.first[at(member) + 1]; ++k) {
        const int other = number[at(graph.other[at(k)])];
        if (other == c) continue;
        if (place[at(other)] < begin) {
          place[at(other)] = static_cast<int>(result.other.size());
          result.other.push_back(other);
          result.weight.push_back(0.0);
        }
        result.weight[at(place[at(other)])] += graph.weight[at(k)];
      }
    }
    result.size.push_back(size);
    result.first.push_back(static_cast<int>(result.other.size()));
  }
  return result;
}

/// Pairs of what is coupled most join, then pairs of those, until there are about `count`.
std::vector<int> partition(const BlockRows& rows, int count) {
  std::vector<int> cluster;
  ClusterGraph graph = single_vertices(rows, cluster);
  const int most = 2 * graph.count() / std::max(count, 1) + 1;
  while (graph.count() > count) {
    int left = 0;
    const std::vector<int> number = match(graph, most, left);
    if (left == graph.count()) break;
    graph = joined(graph, number, left);
    for (int& c : cluster)
      if (c >= 0) c = number[at(c)];
  }
  return cluster;
}

/// Parts of a cluster that only weak blocks join become clusters of their own.
void part_weakly_joined(const BlockRows& rows, std::vector<int>& cluster) {
  core::DisjointSets sets(cluster.size());
  for (Size v = 0; v < cluster.size(); ++v)
    for (int b = rows.first[v]; b < rows.first[v + 1]; ++b) {
      const int w = rows.column[at(b)];
      if (cluster[at(w)] == cluster[v] && coupling(rows, v, b) > kWeak) sets.unite(static_cast<int>(v), w);
    }
  for (Size v = 0; v < cluster.size(); ++v)
    if (cluster[v] >= 0) cluster[v] = sets.find(static_cast<int>(v));
}

/// Clusters of a few vertices join the neighbour that they are coupled to most; then all are numbered in the
/// order of their first vertices.
void join_small(const BlockRows& rows, std::vector<int>& cluster) {
  for (int round = 0; round < kRoundsOfJoining; ++round) {
    std::vector<int> size(cluster.size(), 0);
    for (const int c : cluster)
      if (c >= 0) ++size[at(c)];
    std::map<std::pair<int, int>, double> joins;  // small cluster, neighbour: their couplings
    for (Size v = 0; v < cluster.size(); ++v) {
      if (cluster[v] < 0 || size[at(cluster[v])] >= kLeastVertices) continue;
      for (int b = rows.first[v]; b < rows.first[v + 1]; ++b) {
        const int other = cluster[at(rows.column[at(b)])];
        if (other != cluster[v]) joins[{cluster[v], other}] += block_trace(rows, b);
      }
    }
    if (joins.empty()) break;
    std::map<int, std::pair<double, int>> best;
    for (const auto& [pair, amount] : joins) {
      auto& known = best.try_emplace(pair.first, -1.0, -1).first->second;
      if (amount > known.first) known = {amount, pair.second};
    }
    core::DisjointSets sets(cluster.size());
    for (const auto& [own, other] : best) sets.unite(own, other.second);
    for (int& c : cluster)
      if (c >= 0) c = sets.find(c);
  }
  std::vector<int> number(cluster.size(), -1);
  int count = 0;
  for (int& c : cluster) {
    if (c < 0) continue;
    if (number[at(c)] < 0) number[at(c)] = count++;
    c = number[at(c)];
  }
}

}  // namespace

std::vector<int> cluster_vertices(const BlockRows& rows, int count) {
  std::vector<int> cluster = partition(rows, count);
  part_weakly_joined(rows, cluster);
  join_small(rows, cluster);
  return cluster;
}

}  // namespace shatterbox::stress
