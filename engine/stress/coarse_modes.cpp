#include "engine/stress/coarse_modes.h"

#include <algorithm>
#include <numeric>

#include "engine/core/index.h"
#include "engine/core/parallel.h"
#include "engine/stress/vertex_clusters.h"

namespace shatterbox::stress {
namespace {

using Size = std::size_t;
using core::at;

constexpr Size kVerticesOfCluster = 96;
constexpr Size kMostClusters = 64;
constexpr double kHold = 1e-9;  // of the diagonal: rigid motions of the whole have no stiffness

}  // namespace

CoarseModes::CoarseModes(const BlockRows& rows, const std::vector<Vec3>& positions,
                         const std::vector<Mat3>& allowed, const std::vector<double>& mass)
    : allowed_(allowed) {
  const Size wanted = std::min(kMostClusters, rows.size() / kVerticesOfCluster);
  if (wanted < 2) return;
  cluster_ = cluster_vertices(rows, static_cast<int>(wanted));
  count_ = *std::max_element(cluster_.begin(), cluster_.end()) + 1;
  first_.assign(at(static_cast<int>(count_)) + 1, 0);
  for (const int c : cluster_)
    if (c >= 0) ++first_[at(c) + 1];
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  vertices_.resize(at(first_.back()));
  std::vector<int> next(first_.begin(), first_.end() - 1);
  for (Size v = 0; v < cluster_.size(); ++v)
    if (cluster_[v] >= 0) vertices_[at(next[at(cluster_[v])]++)] = static_cast<int>(v);
  arms_.assign(positions.size(), Vec3::Zero());
  for (Size c = 0; c + 1 < first_.size(); ++c) {
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
  stiffness_ = Eigen::MatrixXd::Zero(size(), size());
  mass_ = stiffness_;
  // By clusters, so that every entry has one writer.
  core::parallel_for(first_.size() - 1, 1, [&](Size c) {
    const auto own = static_cast<Eigen::Index>(6 * c);
    for (int i = first_[c]; i < first_[c + 1]; ++i) {
      const Size v = at(vertices_[at(i)]);
      const Motion here = motion_of(v);
      mass_.block<6, 6>(own, own) += mass[v] * here.transpose() * here;
      for (int b = rows.first[v]; b < rows.first[v + 1]; ++b) {
        const Size w = at(rows.column[at(b)]);
        Mat3 block;
        for (int k = 0; k < 9; ++k) block(k / 3, k % 3) = rows.entries[9 * at(b) + at(k)];
        stiffness_.block<6, 6>(own, 6 * cluster_[w]) += here.transpose() * (block * motion_of(w));
      }
    }
  });
}

/// Three translations and three turns about the cluster's middle.
CoarseModes::Motion CoarseModes::motion_of(Size vertex) const {
  const Vec3& r = arms_[vertex];
  Motion motion;
  motion << 1, 0, 0, 0, r.z(), -r.y(), 0, 1, 0, -r.z(), 0, r.x(), 0, 0, 1, r.y(), -r.x(), 0;
  return allowed_[vertex] * motion;
}

std::optional<CoarseModes::Factor> CoarseModes::factor(double shift) const {
  if (count_ == 0) return std::nullopt;
  Eigen::MatrixXd matrix = stiffness_ + shift * mass_;
  const double hold = kHold * matrix.trace() / static_cast<double>(size());
  matrix.diagonal().array() += hold;
  Factor made(matrix);
  if (made.info() != Eigen::Success) return std::nullopt;
  return made;
}

Eigen::MatrixXd CoarseModes::answer(const Factor& factor, const std::vector<double>& r, Size lanes) const {
  Eigen::MatrixXd sums(size(), static_cast<Eigen::Index>(lanes));
  core::parallel_for(first_.size() - 1, 8, [&](Size c) {
    for (Size l = 0; l < lanes; ++l) {
      Eigen::Matrix<double, 6, 1> sum = Eigen::Matrix<double, 6, 1>::Zero();
      for (int i = first_[c]; i < first_[c + 1]; ++i) {
        const Size v = at(vertices_[at(i)]);
        const double* const u = &r[3 * v * lanes + l];
        const Vec3 force = allowed_[v] * Vec3(u[0], u[lanes], u[2 * lanes]);
        sum.head<3>() += force;
        sum.tail<3>() += arms_[v].cross(force);
      }
      sums.block<6, 1>(static_cast<Eigen::Index>(6 * c), static_cast<Eigen::Index>(l)) = sum;
    }
  });
  return factor.solve(sums);
}

void CoarseModes::add(const Eigen::MatrixXd& amounts, Size vertex, Size lanes, double* z) const {
  if (cluster_[vertex] < 0) return;
  const Eigen::Index own = 6 * cluster_[vertex];
  for (Size l = 0; l < lanes; ++l) {
    const auto lane = static_cast<Eigen::Index>(l);
    const Vec3 move = amounts.block<3, 1>(own, lane), turn = amounts.block<3, 1>(own + 3, lane);
    const Vec3 all = allowed_[vertex] * Vec3(move + turn.cross(arms_[vertex]));
    for (Size a = 0; a < 3; ++a) z[a * lanes + l] += all(static_cast<Eigen::Index>(a));
  }
}

}  // namespace shatterbox::stress
