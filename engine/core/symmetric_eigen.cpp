#include "engine/core/symmetric_eigen.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "engine/core/elementary.h"

namespace shatterbox::core {
namespace {

constexpr int kMostSweeps = 60;        // some eight are taken
constexpr double kNegligible = 1e-17;  // of the largest entry: what moves no eigenvalue's last digit

/// Two columns turned: the first takes `cosine` of itself less `sine` of the second.
void turn(double& first, double& second, double cosine, double sine) {
  const double was = first;
  first = cosine * was - sine * second;
  second = sine * was + cosine * second;
}

}  // namespace

SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& matrix) {
  const Eigen::Index size = matrix.rows();
  Eigen::MatrixXd a = matrix;
  double largest = 0.0;
  for (Eigen::Index i = 0; i < size; ++i)
    for (Eigen::Index j = 0; j <= i; ++j) {
      a(j, i) = a(i, j);
      largest = std::max(largest, std::abs(a(i, j)));
    }
  Eigen::MatrixXd v = Eigen::MatrixXd::Identity(size, size);
  bool is_done = false;
  for (int sweep = 0; sweep < kMostSweeps && !is_done; ++sweep) {
    is_done = true;
    for (Eigen::Index p = 0; p < size; ++p)
      for (Eigen::Index q = p + 1; q < size; ++q) {
        if (std::abs(a(p, q)) <= kNegligible * largest) continue;
        is_done = false;
        const double ratio = 0.5 * (a(q, q) - a(p, p)) / a(p, q);
        const double tangent =
            (ratio < 0.0 ? -1.0 : 1.0) / (std::abs(ratio) + core::sqrt(ratio * ratio + 1.0));
        const double cosine = 1.0 / core::sqrt(tangent * tangent + 1.0), sine = tangent * cosine;
        for (Eigen::Index i = 0; i < size; ++i) turn(a(i, p), a(i, q), cosine, sine);
        for (Eigen::Index i = 0; i < size; ++i) turn(a(p, i), a(q, i), cosine, sine);
        for (Eigen::Index i = 0; i < size; ++i) turn(v(i, p), v(i, q), cosine, sine);
        a(p, q) = a(q, p) = 0.0;
      }
  }
  std::vector<Eigen::Index> order(static_cast<std::size_t>(size));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](Eigen::Index i, Eigen::Index j) { return a(i, i) < a(j, j); });
  SymmetricEigen result{VecX(size), Eigen::MatrixXd(size, size)};
  for (Eigen::Index k = 0; k < size; ++k) {
    const Eigen::Index from = order[static_cast<std::size_t>(k)];
    result.values(k) = a(from, from);
    for (Eigen::Index i = 0; i < size; ++i) result.vectors(i, k) = v(i, from);
  }
  return result;
}

}  // namespace shatterbox::core
