// Vertices in which surfaces meet that touch nowhere else, and parting them.
#pragma once

#include <vector>

#include "engine/geometry/triangle_mesh.h"

namespace shatterbox::geometry {

struct SplitFans {
  int count = 0;   // vertices that had more than one fan
  int first = -1;  // source of the first one
};

/// A vertex whose triangles form several fans, joined in it alone, gets a copy for each further fan. `source`
/// is per vertex and follows.
SplitFans split_vertex_fans(TriangleMesh& mesh, std::vector<int>& source);

}  // namespace shatterbox::geometry
