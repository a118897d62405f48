// Do two triangles cross? They do if their insides (without edges and corners) share a point: transversally,
// or in one plane. What only touches does not cross. Exact.
#pragma once

#include <array>

#include "engine/core/vec.h"

namespace shatterbox::audit {

using Corners = std::array<Vec3, 3>;

/// True if the insides of the triangles share a point. A triangle without area has no inside.
bool triangles_cross(const Corners& p, const Corners& q);

/// The corner of q whose opposite edge lies in the plane of p and passes through the inside of p, while the
/// corner itself lies off the plane; -1 if there is none. Then q touches p along this edge, and crosses it
/// together with its neighbour beyond the edge if that lies on the other side.
int corner_off_hinge(const Corners& p, const Corners& q);

/// True if x and y lie off the plane of the triangle, one on each side.
bool are_on_both_sides(const Corners& triangle, const Vec3& x, const Vec3& y);

}  // namespace shatterbox::audit
