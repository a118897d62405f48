// Counter-based random numbers: the n-th draw of a stream depends on (seed, stream, n) only, so that a stream
// can be copied, saved and resumed, and draws for one body never shift those for another.
#pragma once

#include <cstdint>

#include "engine/core/elementary.h"
#include "engine/core/hash.h"

namespace shatterbox::core {

class Random {
 public:
  explicit Random(std::uint64_t seed = 1, std::uint64_t stream = 0)
      : key_(mix(mix(seed + 0x9e3779b97f4a7c15ULL) ^ (stream * 0xd1342543de82ef95ULL + 1))) {}

  /// The next 64 random bits.
  std::uint64_t bits() { return mix(mix(key_ + 0x9e3779b97f4a7c15ULL * ++counter_) ^ key_); }

  /// Uniform in [0, 1), a multiple of 2^-53.
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1.0p-53; }

  /// Uniform in [low, high).
  double uniform(double low, double high) { return low + (high - low) * uniform(); }

  /// Uniform whole number in [0, count); count > 0. The bias is below 2^-53 times count.
  std::uint64_t index(std::uint64_t count) {
    return static_cast<std::uint64_t>(uniform() * static_cast<double>(count));
  }

  /// Standard normal, by Box and Muller (the second number is not kept: no hidden state).
  double normal() {
    const double radius_uniform = 1.0 - uniform();  // in (0, 1]: the logarithm is finite
    const double turn = uniform();
    return sqrt(-2.0 * log(radius_uniform)) * cos(6.283185307179586 * turn);
  }

 private:
  std::uint64_t key_;
  std::uint64_t counter_ = 0;
};

}  // namespace shatterbox::core
