// Closed surfaces for tests of solids.
#pragma once

#include "engine/geometry/generators.h"

namespace shatterbox::geometry {

/// A mesh as fine as that, m.
inline Meshing fine(double edge_length) {
  Meshing meshing;
  meshing.edge_length = edge_length;
  return meshing;
}

/// Puts another surface beside one.
inline void append(TriangleMesh& mesh, const TriangleMesh& other) {
  const int first = static_cast<int>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
  for (const Triangle& t : other.triangles)
    mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
}

}  // namespace shatterbox::geometry
