// Welding: vertices at the same place become one. Equal means equal to the bit (minus zero is zero): no
// tolerance, so that nothing is ever joined which the file kept apart.
#pragma once

#include <vector>

#include "engine/geometry/triangle_mesh.h"

namespace shatterbox::geometry {

/// For each position the number of the first one equal to it to the bit (its own number where it is the
/// first). Coordinates must be finite.
std::vector<int> find_equal_positions(const std::vector<Vec3>& positions);

/// Makes vertices at equal positions one, keeping the order of first appearance, and renumbers the triangles
/// (whose numbers must be in range). Triangles are neither dropped nor turned. Returns how many vertices
/// went.
int weld_equal_positions(TriangleMesh& mesh);

/// Drops vertices that no triangle uses, keeping the order of the others. Returns how many went.
int drop_unused_vertices(TriangleMesh& mesh);

}  // namespace shatterbox::geometry
