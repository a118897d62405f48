// The vertices of an embedded material as means of their elements' corners. For embedded_material.cpp.
#pragma once

#include <vector>

#include "engine/geometry/face_regions.h"
#include "engine/geometry/solid_complex.h"

namespace shatterbox::geometry {

class SolidVertexMaker {
 public:
  SolidVertexMaker(const SolidElements& elements, const TriangleMesh& surface,
                   const SurfaceCrossings& crossings, const std::vector<Vec3>& positions);

  /// The vertex of that number (CrossingVertices).
  SolidVertex make(int vertex) const;

 private:
  SolidVertex make_mean(int vertex, const int* nodes, const double* weights, std::size_t count) const;

  const SolidElements& elements_;
  const SurfaceCrossings& crossings_;
  const std::vector<Vec3>& positions_;
  CrossingVertices vertices_;
  std::vector<int> crossing_edges_, crossing_faces_;  // per crossing: the mesh's edge, the mesh's face
};

}  // namespace shatterbox::geometry
