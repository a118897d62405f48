// Closed surfaces for tests of solids.
#pragma once

#include "engine/core/random.h"
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

/// Spikes in all directions.
inline TriangleMesh make_star() {
  TriangleMesh star = make_sphere(1.0, fine(0.2)).value();
  core::Random random(3, 3);
  for (Vec3& p : star.positions) p *= random.uniform(0.07, 0.1);
  return star;
}

/// A ball with a hollow of its own centre in it.
inline TriangleMesh make_hollow_ball() {
  TriangleMesh hollow = make_sphere(0.1, fine(0.02)).value();
  TriangleMesh inner = make_sphere(0.07, fine(0.02)).value();
  for (Triangle& t : inner.triangles) std::swap(t[1], t[2]);
  append(hollow, inner);
  return hollow;
}

}  // namespace shatterbox::geometry
