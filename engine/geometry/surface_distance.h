// How far is it to a surface? The nearest place on a triangle mesh, by its tree.
#pragma once

#include <vector>

#include "engine/geometry/bvh.h"
#include "engine/geometry/triangle_mesh.h"

namespace shatterbox::geometry {

struct NearestPlace {
  int triangle = -1;          // -1: none within the radius; of several at one distance the first one found
  Vec3 place = Vec3::Zero();  // m
  double distance = 0.0;      // m
};

/// The surface must outlive it.
class SurfaceDistance {
 public:
  explicit SurfaceDistance(const TriangleMesh& surface);

  /// The place on the surface nearest to p, no farther than `radius` m.
  NearestPlace find(const Vec3& p, double radius) const;

 private:
  const TriangleMesh& surface_;
  TriangleTree tree_;
  std::vector<Box> boxes_;
};

}  // namespace shatterbox::geometry
