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
};
PowerLaw fit_power_law(const std::vector<double>& masses, double least);

}  // namespace shatterbox::sandbox::study
