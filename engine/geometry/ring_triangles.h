// A ring of points of the plane as triangles, whatever its shape: convex or not, with corners on straight
// sides, with parts of no width. The triangles always close the ring, so that what is built of them has no
// gaps.
#pragma once

#include <array>
#include <vector>

#include "engine/core/vec.h"
#include "engine/geometry/triangle_mesh.h"

namespace shatterbox::geometry {

/// n - 2 triangles (places in the ring, in its order) of a ring of n points that turns counter-clockwise.
/// Each side of the ring belongs to one of them, each diagonal to two, once in each direction. Ears are
/// clipped best-shaped first; of a ring that crosses itself by rounding the least bad ones.
std::vector<Triangle> triangulate_ring(const std::vector<Vec2>& ring);

/// One ring (pairs: loop, place in the loop) out of loops of which the first runs about all others, which are
/// its holes and run the other way. Bridges to and from a hole join the same two points.
std::vector<std::array<int, 2>> join_holes(const std::vector<std::vector<Vec2>>& loops);

/// Twice the signed area of a loop, positive if it turns counter-clockwise.
double twice_area(const std::vector<Vec2>& loop);

/// True if the point lies inside the loop.
bool is_inside(const std::vector<Vec2>& loop, const Vec2& point);

}  // namespace shatterbox::geometry
