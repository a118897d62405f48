// A second level for the conjugate gradients of solids: rigid motions of some hundreds of clusters of
// vertices, answered exactly. What hangs by little, as parts between cracks do, and what is long and thin,
// costs block Jacobi alone thousands of iterations, because its soft motions are nearly those. (Y. Saad,
// Iterative Methods for Sparse Linear Systems, second edition, SIAM, 2003, ch. 14.)
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "engine/core/vec.h"
#include "engine/stress/block_rows.h"
#include "engine/stress/front_factor.h"
#include "engine/stress/front_tree.h"

namespace shatterbox::stress {

class CoarseModes {
 public:
  CoarseModes() = default;

  /// `positions`: |V|, in the rows' units; `allowed`: |V|, projectors onto what supports allow; `mass`: |V|.
  /// Clusters hold together what is stiffly joined.
  CoarseModes(const BlockRows& rows, const std::vector<Vec3>& positions, const std::vector<Mat3>& allowed,
              const std::vector<double>& mass);

  /// Of P^T (K + shift M) P; nothing without clusters, or if it is not positive definite.
  using Factor = FrontFactor;
  std::optional<Factor> factor(double shift) const;

  /// (P (P^T (K + shift M) P)^-1 P^T r) for `lanes` vectors side by side (block_rows.h): first what the
  /// clusters are to do (six motions a cluster, lane by lane in each), ...
  template <class Scalar>
  std::vector<double> answer(const Factor& factor, const std::vector<Scalar>& r, std::size_t lanes) const;
  /// ... then what that is at one vertex: adds it to `z` (three unknowns by lanes).
  template <std::size_t kLanes, class Scalar>
  void add(const std::vector<double>& amounts, std::size_t vertex, Scalar* z) const {
    if (cluster_[vertex] < 0) return;
    const double* const move = &amounts[6 * kLanes * static_cast<std::size_t>(cluster_[vertex])];
    const double* const turn = move + 3 * kLanes;
    const double x = arms_[vertex].x(), y = arms_[vertex].y(), w = arms_[vertex].z();
    double all[3][kLanes];
    for (std::size_t l = 0; l < kLanes; ++l) {
      all[0][l] = move[l] + (turn[kLanes + l] * w - turn[2 * kLanes + l] * y);
      all[1][l] = move[kLanes + l] + (turn[2 * kLanes + l] * x - turn[l] * w);
      all[2][l] = move[2 * kLanes + l] + (turn[l] * y - turn[kLanes + l] * x);
    }
    if (is_free_[vertex] != 0) {
      for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t l = 0; l < kLanes; ++l) z[a * kLanes + l] += static_cast<Scalar>(all[a][l]);
      return;
    }
    const Mat3& allowed = allowed_[vertex];
    for (int a = 0; a < 3; ++a)
      for (std::size_t l = 0; l < kLanes; ++l)
        z[static_cast<std::size_t>(a) * kLanes + l] += static_cast<Scalar>(
            (allowed(a, 0) * all[0][l] + allowed(a, 1) * all[1][l]) + allowed(a, 2) * all[2][l]);
  }

 private:
  using Motion = Eigen::Matrix<double, 3, 6>;
  using Block = Eigen::Matrix<double, 6, 6>;
  struct Coupling {
    int other = 0;  // cluster, at most the own one
    Block stiffness = Block::Zero();
  };
  Motion motion_of(std::size_t vertex) const;
  std::vector<Coupling> couplings_of(int cluster, const BlockRows& rows) const;
  void build_tree();
  std::size_t count() const { return first_.empty() ? 0 : first_.size() - 1; }

  std::vector<int> cluster_;           // |V|, -1 for rows without stiffness
  std::vector<int> first_, vertices_;  // of each cluster
  std::vector<Vec3> arms_;             // |V|, from the cluster's middle, in its sizes
  std::vector<Mat3> allowed_;
  std::vector<char> is_free_;                     // |V|: all is allowed
  std::vector<std::vector<Coupling>> couplings_;  // of each cluster: with itself first
  std::vector<Block> mass_;                       // of each cluster
  std::shared_ptr<const FrontTree> tree_;         // of two nodes, move and turn, a cluster
};

}  // namespace shatterbox::stress
