// Against what makes eigenvalues and vectors what they are.
#include "engine/core/symmetric_eigen.h"

#include <catch2/catch.hpp>

#include "engine/core/random.h"

namespace shatterbox::core {
namespace {

Eigen::MatrixXd draw_symmetric(Random& random, Eigen::Index size) {
  Eigen::MatrixXd matrix(size, size);
  for (Eigen::Index i = 0; i < size; ++i)
    for (Eigen::Index j = 0; j <= i; ++j) matrix(i, j) = matrix(j, i) = random.uniform(-1.0, 1.0);
  return matrix;
}

/// Vectors are orthonormal, values ascend, and the matrix times a vector is its value times it.
void check(const Eigen::MatrixXd& matrix) {
  const SymmetricEigen eigen = symmetric_eigen(matrix);
  const double largest = matrix.cwiseAbs().maxCoeff();
  const Eigen::Index size = matrix.rows();
  CHECK((eigen.vectors.transpose() * eigen.vectors - Eigen::MatrixXd::Identity(size, size)).norm() < 1e-13);
  CHECK((matrix * eigen.vectors - eigen.vectors * eigen.values.asDiagonal()).norm() <= 1e-13 * largest);
  for (Eigen::Index i = 1; i < size; ++i) CHECK(eigen.values(i - 1) <= eigen.values(i));
}

}  // namespace

TEST_CASE("symmetric eigen: random matrices, some of low rank, of any size in numbers") {
  Random random(3, 1);
  for (Eigen::Index size = 1; size <= 8; ++size) {
    for (const double scale : {1.0, 1e-140, 1e140}) check(scale * draw_symmetric(random, size));
    const Eigen::MatrixXd some = draw_symmetric(random, size).leftCols((size + 1) / 2);
    check(some * some.transpose());
  }
}

TEST_CASE("symmetric eigen: what is diagonal, all the same or nothing") {
  check(Eigen::Vector3d(3.0, -1.0, 2.0).asDiagonal().toDenseMatrix());
  check(Eigen::MatrixXd::Identity(4, 4));
  check(Eigen::MatrixXd::Zero(4, 4));
  check(Eigen::MatrixXd::Ones(6, 6));
}

TEST_CASE("symmetric eigen: only the lower triangle counts") {
  Random random(4, 1);
  const Eigen::MatrixXd whole = draw_symmetric(random, 5);
  const Eigen::MatrixXd lower = whole.triangularView<Eigen::Lower>();
  CHECK(symmetric_eigen(lower).values == symmetric_eigen(whole).values);
}

}  // namespace shatterbox::core
