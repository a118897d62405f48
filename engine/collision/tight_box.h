// Boxes in single precision, rounded outwards: half the memory of exact ones, and never too small.
#pragma once

#include <algorithm>
#include <cmath>

#include "engine/core/vec.h"

namespace shatterbox::collision {

/// An axis-aligned box that surely holds what was put in; empty as made.
struct TightBox {
  float low[3] = {1e37F, 1e37F, 1e37F};  // m
  float high[3] = {-1e37F, -1e37F, -1e37F};

  void include(const TightBox& other) {
    for (int i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], other.low[i]);
      high[i] = std::max(high[i], other.high[i]);
    }
  }
};

/// Rounding of a number to single precision and of one sum of such numbers stays below this share.
inline constexpr float kOutward = 2.4e-7F;

inline float round_down(double x) {
  const auto f = static_cast<float>(x);
  return f - std::abs(f) * kOutward - 1e-37F;
}

inline float round_up(double x) {
  const auto f = static_cast<float>(x);
  return f + std::abs(f) * kOutward + 1e-37F;
}

/// The box of a ball about `p`.
inline TightBox box_of_point(const Vec3& p, double radius) {
  TightBox box;
  for (int i = 0; i < 3; ++i) {
    box.low[i] = round_down(p[i] - radius);
    box.high[i] = round_up(p[i] + radius);
  }
  return box;
}

/// The box of a ball that goes straight from p to q.
inline TightBox box_of_path(const Vec3& p, const Vec3& q, double radius) {
  TightBox box = box_of_point(p, radius);
  box.include(box_of_point(q, radius));
  return box;
}

/// A way along which boxes are stretched.
struct TightWay {
  float low[3] = {0.0F, 0.0F, 0.0F}, high[3] = {0.0F, 0.0F, 0.0F};

  TightWay() = default;
  explicit TightWay(const Vec3& way) {
    for (int i = 0; i < 3; ++i) {
      low[i] = std::min(0.0F, round_down(way[i]));
      high[i] = std::max(0.0F, round_up(way[i]));
    }
  }
};

inline TightBox stretched(const TightBox& box, const TightWay& way) {
  TightBox result;
  for (int i = 0; i < 3; ++i) {
    result.low[i] = box.low[i] + way.low[i];
    result.high[i] = box.high[i] + way.high[i];
  }
  return result;
}

/// Square of the distance of two boxes, m2; 0 where they overlap. Up to a rounding of 1e-6 never too great.
inline float distance_squared(const TightBox& a, const TightBox& b) {
  const float x = std::max(0.0F, std::max(a.low[0] - b.high[0], b.low[0] - a.high[0]));
  const float y = std::max(0.0F, std::max(a.low[1] - b.high[1], b.low[1] - a.high[1]));
  const float z = std::max(0.0F, std::max(a.low[2] - b.high[2], b.low[2] - a.high[2]));
  return x * x + y * y + z * z;
}

}  // namespace shatterbox::collision
