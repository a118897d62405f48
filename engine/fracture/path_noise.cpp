#include "engine/fracture/path_noise.h"

#include <algorithm>

#include "engine/core/elementary.h"
#include "engine/core/random.h"

namespace shatterbox::fracture {

PathNoise::PathNoise(double wavelength, double amplitude, std::uint64_t seed) {
  core::Random random(seed, 0x77617665);
  for (std::size_t n = 0; n < kWaves; ++n) {
    const double z = random.uniform(-1.0, 1.0);
    const double turn = random.uniform(0.0, 2.0 * core::kPi);
    const double length = wavelength * random.uniform(0.7, 1.5);
    const double r = core::sqrt(std::max(0.0, 1.0 - z * z));
    waves_[n] = 2.0 * core::kPi / length * Vec3(r * core::cos(turn), r * core::sin(turn), z);
    phases_[n] = random.uniform(0.0, 2.0 * core::kPi);
  }
  scale_ = amplitude * core::sqrt(2.0 / kWaves);
}

double PathNoise::at(const Vec3& point) const {
  if (scale_ == 0.0) return 0.0;
  double sum = 0.0;
  for (std::size_t i = 0; i < kWaves; ++i) sum += core::cos(waves_[i].dot(point) + phases_[i]);
  return scale_ * sum;
}

}  // namespace shatterbox::fracture
