#include "sandbox/study/spin_top.h"

#include <array>
#include <cmath>

namespace shatterbox::sandbox::study {

JacobiFunctions jacobi_functions(double u, double m) {
  std::array<double, 20> a{}, c{};
  a[0] = 1.0;
  c[0] = std::sqrt(m);
  double b = std::sqrt(1.0 - m);
  std::size_t n = 0;
  while (std::abs(c[n]) > 1e-17 && n < 18) {
    a[n + 1] = 0.5 * (a[n] + b);
    c[n + 1] = 0.5 * (a[n] - b);
    b = std::sqrt(a[n] * b);
    ++n;
  }
  double phi = std::ldexp(a[n] * u, static_cast<int>(n));
  for (std::size_t i = n; i > 0; --i) phi = 0.5 * (phi + std::asin(c[i] / a[i] * std::sin(phi)));
  const double sn = std::sin(phi);
  return {sn, std::cos(phi), std::sqrt(1.0 - m * sn * sn)};
}

SpinTop::SpinTop(const Vec3& moments, double spin_first, double spin_third) {
  const Vec3 start(spin_first, 0.0, spin_third);
  const double two_e = moments.dot(start.cwiseProduct(start));
  const double l2 = moments.cwiseProduct(start).squaredNorm();
  const double i1 = moments[0], i2 = moments[1], i3 = moments[2];
  rate_ = std::sqrt((i3 - i2) * (l2 - two_e * i1) / moments.prod());
  parameter_ = (i2 - i1) * (two_e * i3 - l2) / ((i3 - i2) * (l2 - two_e * i1));
  amplitude_ =
      Vec3(std::sqrt((two_e * i3 - l2) / (i1 * (i3 - i1))), std::sqrt((two_e * i3 - l2) / (i2 * (i3 - i2))),
           std::sqrt((l2 - two_e * i1) / (i3 * (i3 - i1))));
}

Vec3 SpinTop::spin_at(double time) const {
  const JacobiFunctions j = jacobi_functions(rate_ * time, parameter_);
  return amplitude_.cwiseProduct(Vec3(j.cn, j.sn, j.dn));
}

}  // namespace shatterbox::sandbox::study
