// Features that turn together, hardly apart: along any fixed direction they seem to close, for what is far
// out turns towards it. Along the normal of a plane that turns with them they do not.
#pragma once

#include <array>

#include "engine/core/vec.h"

namespace shatterbox::geometry {

/// m: at least so far apart two features stay, while their vertices go along straight lines from `start` to
/// `end` (world, m): point 0 and the triangle of points 1 to 3, or the edges of points 0 and 1 and of points
/// 2 and 3. Told along the normals of planes that go with them: the triangle's, that of both edges, and those
/// about one of their edges; `direction` leads from the second feature to the first one now, about. Zero if
/// no such plane tells. The distance along a normal is a cubic over the normal's length; it is bounded by its
/// Bernstein coefficients, less what rounding may have added.
double separation_by_moving_plane(const std::array<Vec3, 4>& start, const std::array<Vec3, 4>& end,
                                  bool is_edge_edge, const Vec3& direction);

}  // namespace shatterbox::geometry
