// A polygon of the plane as triangles.
#pragma once

#include <vector>

#include "engine/core/vec.h"
#include "engine/geometry/triangle_mesh.h"

namespace shatterbox::geometry {

/// Triangles (numbers of the polygon's corners) of a polygon that does not cross itself and turns
/// counter-clockwise; corners may lie on its straight sides. The best-shaped ear is clipped again and again,
/// never one that leaves only a line behind. What has no area is left out.
std::vector<Triangle> clip_ears(std::vector<Vec2> polygon);

}  // namespace shatterbox::geometry
