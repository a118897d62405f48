// Signs of volumes and areas of points as they are stored: exact. A bound on rounding decides the many clear
// cases, expansions (sums of doubles that do not overlap) [She97] the others. Coordinates of sizes
// from 1e-70 to 1e70.
#pragma once

#include <limits>

#include "engine/core/vec.h"

namespace shatterbox::audit {

/// The most that one rounding changes a number, as a share of it.
inline constexpr double kUnit = 0.5 * std::numeric_limits<double>::epsilon();

/// Sign of det(a - d, b - d, c - d), six times the volume of the tetrahedron: -1, 0 or 1.
int volume_sign(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// Sign of the area of the triangle (a, b, c): 1 if it turns counter-clockwise.
int area_sign(const Vec2& a, const Vec2& b, const Vec2& c);

}  // namespace shatterbox::audit
