// Lines in the plane.
#pragma once

#include "engine/core/vec.h"

namespace shatterbox::geometry {

/// Twice the area of the triangle a b c; more than 0 if it turns counter-clockwise.
inline double turn(const Vec2& a, const Vec2& b, const Vec2& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// Whether the lines from a to b and from c to d cross, each within the other; that they touch is not enough.
inline bool do_cross(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const auto opposite = [](double p, double q) { return (p > 0.0 && q < 0.0) || (p < 0.0 && q > 0.0); };
  return opposite(turn(a, b, c), turn(a, b, d)) && opposite(turn(c, d, a), turn(c, d, b));
}

}  // namespace shatterbox::geometry
