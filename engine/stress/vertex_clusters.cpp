#include "engine/stress/vertex_clusters.h"

#include <metis.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "engine/core/disjoint_sets.h"
#include "engine/core/elementary.h"
#include "engine/core/index.h"
#include "engine/stress/metis_lock.h"

namespace shatterbox::stress {
namespace {

using Size = std::size_t;
using core::at;

constexpr double kWeights = 1000.0;  // of the stiffest coupling, as METIS takes whole numbers

constexpr double kOffTies = 0.382;  // so that rounding tips no coupling that is a simple fraction
constexpr double kWeak = 0.03;      // share of both ends' stiffness below which an edge joins nothing
constexpr int kLeastVertices = 4;   // of a cluster
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

/// By METIS.
std::vector<int> partition(const BlockRows& rows, int count) {
  std::vector<int> number(rows.size(), -1), cluster(rows.size(), -1);
  idx_t vertex_count = 0;
  for (Size v = 0; v < rows.size(); ++v)
    if (rows.first[v] < rows.first[v + 1]) number[v] = static_cast<int>(vertex_count++);
  std::vector<idx_t> first{0}, neighbours, weights;
  for (Size v = 0; v < rows.size(); ++v) {
    if (number[v] < 0) continue;
    for (int b = rows.first[v] + 1; b < rows.first[v + 1]; ++b) {
      neighbours.push_back(number[at(rows.column[at(b)])]);
      weights.push_back(1 + static_cast<idx_t>(kWeights * coupling(rows, v, b) + kOffTies));
    }
    first.push_back(static_cast<idx_t>(neighbours.size()));
  }
  std::vector<idx_t> part(at(static_cast<int>(vertex_count)), 0);
  if (count > 1 && vertex_count > count && !neighbours.empty()) {
    std::array<idx_t, METIS_NOPTIONS> options{};
    idx_t constraints = 1, parts = count, cut = 0;
    const std::lock_guard lock(metis_lock());
    METIS_SetDefaultOptions(options.data());
    options[METIS_OPTION_SEED] = 1;
    options[METIS_OPTION_NUMBERING] = 0;
    const int status =
        METIS_PartGraphKway(&vertex_count, &constraints, first.data(), neighbours.data(), nullptr, nullptr,
                            weights.data(), &parts, nullptr, nullptr, options.data(), &cut, part.data());
    if (status != METIS_OK) std::fill(part.begin(), part.end(), 0);
  }
  for (Size v = 0; v < rows.size(); ++v)
    if (number[v] >= 0) cluster[v] = static_cast<int>(part[at(number[v])]);
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
