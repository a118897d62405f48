// Surfaces whose triangles are too large to bend: the same surface in smaller ones.
#pragma once

#include "engine/geometry/triangle_mesh.h"

namespace shatterbox::geometry {

/// The same surface with no edge longer than `longest` (m): the longest edge of all is halved, and with it
/// the triangles at it, until none is longer. So triangles fit together wherever they did, also where three
/// meet, and no angle becomes less than half of what it was (longest-edge bisection [RS75]). Its vertices are
/// the first of the answer's.
TriangleMesh divide_long_edges(const TriangleMesh& mesh, double longest);

}  // namespace shatterbox::geometry
