// Study "fragments": sizes of pieces and counts of cracks over many seeds, beside published laws.
#pragma once

#include "sandbox/study/study.h"

namespace shatterbox::sandbox::study {

Study fragments_study();

/// The exponent of a power law's density m^-exponent above `least`, by maximum likelihood, and the half width
/// of its 95 % confidence interval. NaN where fewer than two masses are above.
struct PowerLaw {
  double exponent = 0.0;
  double half_width = 0.0;
  int count = 0;  // masses above `least`
  /// Greatest difference between the share of masses that are heavier and what the law says (Kolmogorov,
  /// Smirnov), and what 95 % of samples of a power law stay below (Stephens 1974: an exponential's, fitted).
  double distance = 0.0, usual_distance = 0.0;
  bool is_one() const { return distance <= usual_distance; }
};
PowerLaw fit_power_law(const std::vector<double>& masses, double least);

}  // namespace shatterbox::sandbox::study
