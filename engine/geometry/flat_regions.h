// A flat region with any border, holes too, as convex polygons over the same vertices.
#pragma once

#include <vector>

#include "engine/core/vec.h"

namespace shatterbox::geometry {

/// Divides the region bounded by `loops` (vertex numbers: outer borders counter-clockwise about `normal`,
/// holes clockwise; they do not cross) into convex polygons that turn counter-clockwise. A convex region
/// stays one polygon. Whatever the positions, each side of a loop is a side of one polygon, in its direction,
/// and all other sides come in pairs of opposite directions: what is closed stays closed, even where rounding
/// has folded a narrow region. No vertex is added.
std::vector<std::vector<int>> divide_flat_region(const std::vector<Vec3>& positions,
                                                 const std::vector<std::vector<int>>& loops,
                                                 const Vec3& normal);

}  // namespace shatterbox::geometry
