#include "engine/stress/coarse_modes.h"

#include <algorithm>
#include <array>

#include "engine/core/buckets.h"
#include "engine/core/index.h"
#include "engine/core/parallel.h"
#include "engine/stress/elimination_order.h"
#include "engine/stress/front_solve.h"
#include "engine/stress/vertex_clusters.h"

namespace shatterbox::stress {
namespace {

using Size = std::size_t;
using core::at;

constexpr Size kVerticesOfCluster = 48;
constexpr Size kMostClusters = 384;
constexpr double kHold = 1e-7;  // of the diagonal: rigid motions of the whole have no stiffness

constexpr Size kPairUnknowns = 12;  // of two clusters
using PairEntries = std::array<double, kPairUnknowns*(kPairUnknowns + 1) / 2>;

/// Place in PairEntries of a row and a column of the lower triangle.
constexpr Size entry_at(Size row, Size column) {
  return column * kPairUnknowns - column * (column + 1) / 2 + row;
}

}  // namespace

CoarseModes::CoarseModes(const BlockRows& rows, const std::vector<Vec3>& positions,
                         const std::vector<Mat3>& allowed, const std::vector<double>& mass)
    : allowed_(allowed) {
  const Size wanted = std::min(kMostClusters, rows.size() / kVerticesOfCluster);
  if (wanted < 2) return;
  cluster_ = cluster_vertices(rows, static_cast<int>(wanted));
  core::Buckets clusters(at(*std::max_element(cluster_.begin(), cluster_.end())) + 1, cluster_.size(),
                         [&](Size vertex) { return cluster_[vertex]; });
  first_ = std::move(clusters.first);
  vertices_ = std::move(clusters.items);
  arms_.assign(positions.size(), Vec3::Zero());
  for (Size c = 0; c < count(); ++c) {
    const int* const begin = vertices_.data() + first_[c];
    const int* const end = vertices_.data() + first_[c + 1];
    if (begin == end) continue;
    Vec3 middle = Vec3::Zero();
    for (const int* v = begin; v != end; ++v) middle += positions[at(*v)];
    middle /= static_cast<double>(end - begin);
    double size = 1e-300;
    for (const int* v = begin; v != end; ++v) size = std::max(size, (positions[at(*v)] - middle).norm());
    for (const int* v = begin; v != end; ++v) arms_[at(*v)] = (positions[at(*v)] - middle) / size;
  }
  is_free_.resize(allowed_.size());
  for (Size v = 0; v < allowed_.size(); ++v) is_free_[v] = allowed_[v] == Mat3::Identity() ? 1 : 0;
  couplings_.resize(count());
  mass_.assign(count(), Block::Zero());
  core::parallel_for(count(), 1, [&](Size c) {
    couplings_[c] = couplings_of(static_cast<int>(c), rows);
    for (int i = first_[c]; i < first_[c + 1]; ++i) {
      const Size v = at(vertices_[at(i)]);
      const Motion here = motion_of(v);
      mass_[c] += mass[v] * here.transpose() * here;
    }
  });
  build_tree();
}

/// Three translations and three turns about the cluster's middle.
CoarseModes::Motion CoarseModes::motion_of(Size vertex) const {
  const Vec3& r = arms_[vertex];
  Motion motion;
  motion << 1, 0, 0, 0, r.z(), -r.y(), 0, 1, 0, -r.z(), 0, r.x(), 0, 0, 1, r.y(), -r.x(), 0;
  return allowed_[vertex] * motion;
}

/// With itself and with those of lower numbers that it has blocks with, in the order in which they are found.
std::vector<CoarseModes::Coupling> CoarseModes::couplings_of(int cluster, const BlockRows& rows) const {
  std::vector<Coupling> found{{cluster, Block::Zero()}};
  const auto of = [&](int other) -> Block& {
    for (Coupling& coupling : found)
      if (coupling.other == other) return coupling.stiffness;
    found.push_back({other, Block::Zero()});
    return found.back().stiffness;
  };
  for (int i = first_[at(cluster)]; i < first_[at(cluster) + 1]; ++i) {
    const Size v = at(vertices_[at(i)]);
    const Motion here = motion_of(v);
    for (int b = rows.first[v]; b < rows.first[v + 1]; ++b) {
      const Size w = at(rows.column[at(b)]);
      if (cluster_[w] < 0 || cluster_[w] > cluster) continue;
      Mat3 block;
      for (int k = 0; k < 9; ++k) block(k / 3, k % 3) = rows.entries[9 * at(b) + at(k)];
      of(cluster_[w]) += here.transpose() * (block * motion_of(w));
    }
  }
  return found;
}

/// An element for each cluster by itself and one for each pair that is coupled.
void CoarseModes::build_tree() {
  NodeGraph graph;
  graph.element_unknowns = {3, 3, 3, 3, 0, 0};
  graph.node_size.assign(2 * count(), 3);
  std::vector<std::array<int, 2>> pairs;
  for (Size c = 0; c < count(); ++c)
    for (const Coupling& coupling : couplings_[c]) {
      const int own = static_cast<int>(2 * c), other = 2 * coupling.other;
      if (other == own) {
        graph.elements.push_back({own, own + 1, -1, -1, -1, -1});
      } else {
        graph.elements.push_back({other, other + 1, own, own + 1, -1, -1});
        pairs.push_back({coupling.other, static_cast<int>(c)});
      }
    }
  std::sort(pairs.begin(), pairs.end());
  const std::vector<int> rank = rank_vertices(count(), pairs);
  std::vector<int> order(2 * count());
  for (Size c = 0; c < count(); ++c)
    for (Size k = 0; k < 2; ++k) order[2 * at(rank[c]) + k] = static_cast<int>(2 * c + k);
  tree_ = std::make_shared<const FrontTree>(build_front_tree(graph, order));
}

std::optional<CoarseModes::Factor> CoarseModes::factor(double shift) const {
  if (count() == 0) return std::nullopt;
  std::vector<PairEntries> entries;
  double trace = 0.0;
  for (Size c = 0; c < count(); ++c)
    for (const Coupling& coupling : couplings_[c]) {
      PairEntries& own = entries.emplace_back();
      own.fill(0.0);
      if (at(coupling.other) == c) {
        const Block block = coupling.stiffness + shift * mass_[c];
        trace += block.trace();
        for (Size j = 0; j < 6; ++j)
          for (Size i = j; i < 6; ++i)
            own[entry_at(i, j)] = block(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
      } else {
        for (Size j = 0; j < 6; ++j)
          for (Size i = 0; i < 6; ++i)
            own[entry_at(6 + i, j)] =
                coupling.stiffness(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
      }
    }
  const double hold = kHold * trace / (6.0 * static_cast<double>(count()));
  return FrontFactor::make(*tree_, std::vector<double>(at(tree_->unknowns), hold), [&](int e) {
    return ElementEntries{entries[at(e)].data(), 1.0};
  });
}

template <class Scalar>
std::vector<double> CoarseModes::answer(const Factor& factor, const std::vector<Scalar>& r,
                                        Size lanes) const {
  SolveLanes x(*tree_, lanes);
  const Size stride = at(x.lanes);
  core::parallel_for(count(), 8, [&](Size c) {
    std::array<double*, 6> sums{};
    for (Size k = 0; k < 6; ++k)
      sums[k] = &x.values[stride * at(tree_->node_place[2 * c + k / 3])] + stride * (k % 3);
    for (int i = first_[c]; i < first_[c + 1]; ++i) {
      const Size v = at(vertices_[at(i)]);
      for (Size l = 0; l < lanes; ++l) {
        const Scalar* const u = &r[3 * v * lanes + l];
        Vec3 force(u[0], u[lanes], u[2 * lanes]);
        if (is_free_[v] == 0) force = (allowed_[v] * force).eval();
        const Vec3 turn = arms_[v].cross(force);
        for (Size k = 0; k < 3; ++k) {
          sums[k][l] += force(static_cast<Eigen::Index>(k));
          sums[3 + k][l] += turn(static_cast<Eigen::Index>(k));
        }
      }
    }
  });
  solve_forward(*tree_, factor, x);
  solve_backward(*tree_, factor, x);
  std::vector<double> amounts(6 * count() * lanes);
  for (Size c = 0; c < count(); ++c)
    for (Size k = 0; k < 6; ++k)
      for (Size l = 0; l < lanes; ++l)
        amounts[(6 * c + k) * lanes + l] =
            x.values[stride * (at(tree_->node_place[2 * c + k / 3]) + k % 3) + l];
  return amounts;
}

template std::vector<double> CoarseModes::answer(const Factor&, const std::vector<double>&, Size) const;
template std::vector<double> CoarseModes::answer(const Factor&, const std::vector<float>&, Size) const;

}  // namespace shatterbox::stress
