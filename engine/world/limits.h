// What comes through the door is no more than this: more could not be followed through a step.
#pragma once

#include "engine/core/vec.h"

namespace shatterbox::world {

inline constexpr double kMostLength = 1e6;   // m: of places and extents
inline constexpr double kMostSpeed = 1e9;    // m/s: worlds may be large
inline constexpr double kMostSpin = 1e5;     // rad/s
inline constexpr double kMostAngle = 1e6;    // rad: of the keys of a path
inline constexpr double kMostGravity = 1e9;  // m/s2
inline constexpr double kMostForce = 1e9;    // N, N m
inline constexpr double kMostEnergy = 1e12;  // J: of explosions

/// Whether all numbers are there, and none beyond `most`.
inline bool is_within(const Vec3& numbers, double most) {
  return numbers.allFinite() && numbers.cwiseAbs().maxCoeff() <= most;
}

/// Whether it is a number above zero and not beyond `most`.
inline bool is_positive(double number, double most = 1e300) {
  return number > 0.0 && number <= most;
}

}  // namespace shatterbox::world
