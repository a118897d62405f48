// A second level for the conjugate gradients of solids: rigid motions of some dozen clusters of vertices,
// answered exactly. What hangs by little, as parts between cracks do, and what is long and thin, costs block
// Jacobi alone thousands of iterations, because its soft motions are nearly those. (Y. Saad, Iterative
// Methods for Sparse Linear Systems, second edition, SIAM, 2003, ch. 14.)
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Cholesky>

#include "engine/core/vec.h"
#include "engine/stress/block_rows.h"

namespace shatterbox::stress {

class CoarseModes {
 public:
  CoarseModes() = default;

  /// `positions`: |V|, in the rows' units; `allowed`: |V|, projectors onto what supports allow; `mass`: |V|.
  /// Clusters hold together what is stiffly joined.
  CoarseModes(const BlockRows& rows, const std::vector<Vec3>& positions, const std::vector<Mat3>& allowed,
              const std::vector<double>& mass);

  /// Of P^T (K + shift M) P; nothing without clusters, or if it is not positive definite.
  using Factor = Eigen::LLT<Eigen::MatrixXd>;
  std::optional<Factor> factor(double shift) const;

  /// Modes: six a cluster.
  Eigen::Index size() const { return 6 * count_; }

  /// (P (P^T (K + shift M) P)^-1 P^T r) for `lanes` vectors side by side (block_rows.h): first what the
  /// clusters are to do (|modes| x lanes), ...
  Eigen::MatrixXd answer(const Factor& factor, const std::vector<double>& r, std::size_t lanes) const;
  /// ... then what that is at one vertex: adds it to `z` (three unknowns by lanes).
  void add(const Eigen::MatrixXd& amounts, std::size_t vertex, std::size_t lanes, double* z) const;

 private:
  using Motion = Eigen::Matrix<double, 3, 6>;
  Motion motion_of(std::size_t vertex) const;

  Eigen::Index count_ = 0;
  std::vector<int> cluster_;           // |V|, -1 for rows without stiffness
  std::vector<int> first_, vertices_;  // of each cluster
  std::vector<Vec3> arms_;             // |V|, from the cluster's middle, in its sizes
  std::vector<Mat3> allowed_;
  Eigen::MatrixXd stiffness_, mass_;  // |modes| x |modes|
};

}  // namespace shatterbox::stress
