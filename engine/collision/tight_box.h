// Boxes in single precision, rounded outwards: never too small. Four lanes are worked on at once: x, y, z and
// their sum, which cuts off two of a box's corners.
#pragma once

#include <cmath>
#if defined(__SSE2__)
#include <emmintrin.h>
#endif

#include "engine/core/vec.h"

namespace shatterbox::collision {

typedef float BoxLanes __attribute__((vector_size(16)));

inline BoxLanes lesser(BoxLanes a, BoxLanes b) {
  return a < b ? a : b;
}
inline BoxLanes greater(BoxLanes a, BoxLanes b) {
  return a > b ? a : b;
}

/// An axis-aligned box that surely holds what was put in; empty as made.
struct TightBox {
  BoxLanes low = {1e18F, 1e18F, 1e18F, 1e18F};  // m
  BoxLanes high = {-1e18F, -1e18F, -1e18F, -1e18F};

  void include(const TightBox& other) {
    low = lesser(low, other.low);
    high = greater(high, other.high);
  }
};

/// Rounding of a number to single precision and of one sum of such numbers stays below this share.
inline constexpr float kOutward = 2.4e-7F;

/// Square root of 3, not less: of what is a metre apart, the sums of coordinates differ by no more, m.
inline constexpr double kDiagonal = 1.7320508075688774;

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
  const double along = p.sum(), reach = kDiagonal * radius;
  TightBox box;
  box.low = BoxLanes{round_down(p[0] - radius), round_down(p[1] - radius), round_down(p[2] - radius),
                     round_down(along - reach)};
  box.high = BoxLanes{round_up(p[0] + radius), round_up(p[1] + radius), round_up(p[2] + radius),
                      round_up(along + reach)};
  return box;
}

/// The box of a ball that goes straight from p to q.
inline TightBox box_of_path(const Vec3& p, const Vec3& q, double radius) {
  TightBox box = box_of_point(p, radius);
  box.include(box_of_point(q, radius));
  return box;
}

/// How far apart two boxes are along each axis, m, and in the sum of coordinates; negative where they
/// overlap.
inline BoxLanes apart(const TightBox& a, const TightBox& b) {
  return greater(a.low - b.high, b.low - a.high);
}

/// True if any of the lanes is greater than that of `bound`.
inline bool any_exceeds(BoxLanes lanes, BoxLanes bound) {
#if defined(__SSE2__)
  return _mm_movemask_ps(_mm_cmpgt_ps(lanes, bound)) != 0;
#else
  return lanes[0] > bound[0] || lanes[1] > bound[1] || lanes[2] > bound[2] || lanes[3] > bound[3];
#endif
}

/// Square of the distance of two boxes, m2; 0 where they overlap. Up to a rounding of 1e-6 never too great.
inline float distance_squared(const TightBox& a, const TightBox& b) {
  const BoxLanes nought = {0.0F, 0.0F, 0.0F, 0.0F};
  const BoxLanes gaps = greater(apart(a, b), nought);
  const BoxLanes squares = gaps * gaps;
  return (squares[0] + squares[1]) + squares[2];
}

}  // namespace shatterbox::collision
