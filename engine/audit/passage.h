// Did a vertex pass through a triangle, or an edge through an edge, on straight paths from one time to
// another? Only certain passages count: the volume of the four vertices surely changes its sign while the
// features surely overlap. What comes within rounding of touching without passing for certain is told apart.
#pragma once

#include <array>

#include "engine/core/vec.h"

namespace shatterbox::audit {

enum class Passage {
  none,       // for certain
  passed,     // for certain
  unsettled,  // they touch, or miss each other, by no more than rounding
};

using FourPoints = std::array<Vec3, 4>;

/// Points: the vertex, then the triangle's corners.
Passage vertex_through_triangle(const FourPoints& start, const FourPoints& end);

/// Points: the ends of one edge, then those of the other.
Passage edge_through_edge(const FourPoints& start, const FourPoints& end);

}  // namespace shatterbox::audit
