// The torque-free asymmetric top in closed form: Jacobi's elliptic functions (Landau & Lifshitz, Mechanics,
// sec. 37).
#pragma once

#include "engine/core/vec.h"

namespace shatterbox::sandbox::study {

struct JacobiFunctions {
  double sn = 0.0, cn = 1.0, dn = 1.0;
};

/// sn, cn, dn of argument u and parameter m in [0, 1), by the descending Landen transformation.
JacobiFunctions jacobi_functions(double u, double m);

/// A top that starts with no spin about its middle axis and with more momentum than the middle axis' alone
/// would have: L^2 > 2 E I2.
class SpinTop {
 public:
  /// Principal moments ascending, kg m2; spin about the first and the third axis at time 0, rad/s.
  SpinTop(const Vec3& moments, double spin_first, double spin_third);

  /// Spin about the principal axes at a time (s), rad/s.
  Vec3 spin_at(double time) const;

 private:
  Vec3 amplitude_ = Vec3::Zero();  // rad/s
  double rate_ = 0.0;              // 1/s
  double parameter_ = 0.0;
};

}  // namespace shatterbox::sandbox::study
