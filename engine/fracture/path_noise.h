// A smooth random bend of crack paths, fixed in material space.
#pragma once

#include <array>
#include <cstdint>

#include "engine/core/vec.h"

namespace shatterbox::fracture {

/// A sum of plane waves of random directions and phases.
class PathNoise {
 public:
  PathNoise(double wavelength, double amplitude, std::uint64_t seed);
  /// rad; zero on average, `amplitude` by root mean square.
  double at(const Vec3& point) const;

 private:
  static constexpr int kWaves = 24;
  std::array<Vec3, kWaves> waves_;
  std::array<double, kWaves> phases_{};
  double scale_ = 0.0;
};

}  // namespace shatterbox::fracture
