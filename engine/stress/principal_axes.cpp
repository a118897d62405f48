#include "engine/stress/principal_axes.h"

#include <cmath>
#include <utility>

#include "engine/core/elementary.h"

namespace shatterbox::stress {
namespace {

/// Turns the axes p and q so that the entry between them vanishes (Golub and Van Loan, 8.5).
void rotate(Mat3& a, Mat3& turned, int p, int q) {
  const double theta = 0.5 * (a(q, q) - a(p, p)) / a(p, q);
  // A tiny entry beside a great difference: theta may not be squared.
  const double t = std::abs(theta) > 1e150
                       ? 0.5 / theta
                       : (theta >= 0.0 ? 1.0 : -1.0) / (std::abs(theta) + core::sqrt(theta * theta + 1.0));
  const double c = 1.0 / core::sqrt(t * t + 1.0);
  const double s = t * c;
  const int r = 3 - p - q;
  const double arp = a(r, p), arq = a(r, q), apq = a(p, q);
  a(p, p) -= t * apq;
  a(q, q) += t * apq;
  a(p, q) = a(q, p) = 0.0;
  a(r, p) = a(p, r) = c * arp - s * arq;
  a(r, q) = a(q, r) = s * arp + c * arq;
  for (int i = 0; i < 3; ++i) {
    const double vp = turned(i, p), vq = turned(i, q);
    turned(i, p) = c * vp - s * vq;
    turned(i, q) = s * vp + c * vq;
  }
}

}  // namespace

PrincipalAxes find_principal_axes(const Mat3& tensor) {
  constexpr double kNothing = 1e-17;  // of the greatest entry
  constexpr int kMostSweeps = 12;     // three to five do
  PrincipalAxes axes;
  double greatest = 0.0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j <= i; ++j) greatest = std::max(greatest, std::abs(tensor(i, j)));
  if (!(greatest > 0.0) || !std::isfinite(greatest)) return axes;
  Mat3 a;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j <= i; ++j) a(i, j) = a(j, i) = tensor(i, j) / greatest;
  Mat3 turned = Mat3::Identity();
  for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
    bool is_diagonal = true;
    for (const auto& [p, q] : {std::pair{0, 1}, std::pair{0, 2}, std::pair{1, 2}}) {
      if (!(std::abs(a(p, q)) > kNothing)) continue;
      rotate(a, turned, p, q);
      is_diagonal = false;
    }
    if (is_diagonal) break;
  }
  int order[3] = {0, 1, 2};
  const auto swap_if_less = [&](int i, int j) {
    if (a(order[i], order[i]) < a(order[j], order[j])) std::swap(order[i], order[j]);
  };
  swap_if_less(0, 1);
  swap_if_less(1, 2);
  swap_if_less(0, 1);
  for (int i = 0; i < 3; ++i) {
    axes.values(i) = greatest * a(order[i], order[i]);
    axes.directions.col(i) = turned.col(order[i]);
  }
  axes.directions.col(2) = axes.directions.col(0).cross(axes.directions.col(1));
  return axes;
}

}  // namespace shatterbox::stress
