// How far material flows under a linear stress: where that is q times the yield strength, flow at that
// strength takes up what of the linear energy of distortion is above it [MG81].
#pragma once

#include <algorithm>

namespace shatterbox::stress {

struct YieldLaw {
  double yield = 0.0;        // Pa, von Mises
  double most_strain = 0.0;  // plastic strain beyond which it would tear
  double energy = 0.0;       // J of the impact: if the linear stress holds less, as much more flows
};

/// Times what flow takes up, if the linear stress holds `held` J of distortion.
inline double flow_gain(const YieldLaw& law, double held) {
  return held > 0.0 ? std::max(1.0, law.energy / held) : 1.0;
}

/// Equivalent plastic strain where the linear von Mises stress is `linear` Pa; `shear`: modulus, Pa.
inline double flow_strain(const YieldLaw& law, double linear, double shear, double gain) {
  if (!(linear > law.yield)) return 0.0;
  const double over = linear / law.yield;
  return std::min(law.most_strain, gain * 0.5 * (over * over - 1.0) * law.yield / (3.0 * shear));
}

}  // namespace shatterbox::stress
