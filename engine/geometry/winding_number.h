// How often a surface winds about a point, also one that is open or passes through itself: the generalised
// winding number [JKSH13], far triangles together by their area vectors [BDSLJ18].
#pragma once

#include <vector>

#include "engine/geometry/bvh.h"
#include "engine/geometry/triangle_mesh.h"

namespace shatterbox::geometry {

/// The surface must outlive it.
class WindingNumber {
 public:
  explicit WindingNumber(const TriangleMesh& surface);

  /// 1 inside and 0 outside of a closed surface that faces outwards, whole numbers where it overlaps itself,
  /// something between them near holes. Off by some thousandths.
  double about(const Vec3& p) const;

 private:
  struct Cluster {
    Vec3 centre = Vec3::Zero();       // m, of its area
    Vec3 area_vector = Vec3::Zero();  // m2
    double radius = 0.0;              // m, about the centre
  };

  double of_triangle(int triangle, const Vec3& p) const;

  const TriangleMesh& surface_;
  TriangleTree tree_;
  std::vector<Cluster> clusters_;  // of the tree's nodes
};

}  // namespace shatterbox::geometry
