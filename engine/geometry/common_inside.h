// Do two closed surfaces enclose something together where no edge of one goes through the other? Blocks that
// are pushed into each other with their sides in one plane touch only there.
#pragma once

#include "engine/geometry/triangle_mesh.h"

namespace shatterbox::geometry {

/// True if a place on one of two closed surfaces that face outwards (in one space) lies inside the other,
/// further than `least` (m) from its surface, or one that is twice as far within: five places of each triangle
/// are asked, of great surfaces of some hundred of them.
bool have_common_inside(const TriangleMesh& a, const TriangleMesh& b, double least);

}  // namespace shatterbox::geometry
