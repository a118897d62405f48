// Corners of a flat shard: of its outline, drawn with as few straight lines as come near to it.
#pragma once

#include "engine/geometry/triangle_mesh.h"

namespace shatterbox::sandbox::study {

/// Corners of the longest border of an open surface that lies about in a plane, by lines [DP73] that stay
/// within `tolerance` m of it. 0 where there is no border.
int count_corners(const geometry::TriangleMesh& shard, double tolerance);

}  // namespace shatterbox::sandbox::study
