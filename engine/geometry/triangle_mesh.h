// A plain indexed triangle mesh: the common coin of geometry, collision and pictures.
#pragma once

#include <array>
#include <vector>

#include "engine/core/vec.h"

namespace shatterbox::geometry {

using Triangle = std::array<int, 3>;  // vertex numbers, counter-clockwise seen from outside

struct TriangleMesh {
  std::vector<Vec3> positions;      // |V| x 3, m
  std::vector<Triangle> triangles;  // |T| x 3
};

}  // namespace shatterbox::geometry
