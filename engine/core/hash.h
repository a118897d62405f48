// A 64-bit hash of numbers, for the state hash that pins a run to its bits (DESIGN: the same scene, the same
// bits).
#pragma once

#include <bit>
#include <cstdint>

#include "engine/core/vec.h"

namespace shatterbox::core {

/// One round of the SplitMix64 finaliser: a bijection of 64-bit words without visible structure.
constexpr std::uint64_t mix(std::uint64_t x) {
  x ^= x >> 30;
  x *= 0xbf58476d1ce4e5b9ULL;
  x ^= x >> 27;
  x *= 0x94d049bb133111ebULL;
  x ^= x >> 31;
  return x;
}

/// Chained hash; the order of the additions matters. Minus zero hashes as zero.
class Hash {
 public:
  explicit Hash(std::uint64_t start = 0x5b7a77e2b0c5u) : state_(start) {}

  Hash& add(std::uint64_t word) {
    state_ = mix(state_ ^ word) + 0x9e3779b97f4a7c15ULL;
    return *this;
  }
  Hash& add(double number) { return add(std::bit_cast<std::uint64_t>(number + 0.0)); }
  Hash& add(const Vec3& v) { return add(v.x()).add(v.y()).add(v.z()); }
  Hash& add(const Quat& q) { return add(q.w()).add(q.x()).add(q.y()).add(q.z()); }

  std::uint64_t value() const { return mix(state_); }

 private:
  std::uint64_t state_;
};

}  // namespace shatterbox::core
