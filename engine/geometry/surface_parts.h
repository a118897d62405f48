// What of the given surface lies in each tetrahedron: each triangle divided into convex polygons. For
// embedded_material.cpp.
#pragma once

#include <vector>

#include "engine/geometry/face_regions.h"

namespace shatterbox::geometry {

/// A part of a triangle of the surface, in one tetrahedron.
struct SurfacePart {
  int triangle = 0;
  std::vector<int> corners;  // counter-clockwise seen from outside of the surface
};

class SurfaceParts {
 public:
  /// `segments` of all faces, by `first_segment` (|F| + 1).
  SurfaceParts(const SolidElements& elements, const TriangleMesh& surface, const EdgeTopology& surface_edges,
               const SurfaceCrossings& crossings, const std::vector<int>& first_segment,
               const std::vector<SurfaceSegment>& segments);

  /// Finds the parts in a tetrahedron. False if what crosses it does not fit together.
  bool find(int tetrahedron);
  const std::vector<SurfacePart>& parts() const { return parts_; }

 private:
  /// A side of a triangle begins or ends in a tetrahedron: by its own end, or by a face.
  struct SideEnd {
    int edge, vertex;
    bool is_begin;  // on the way from the edge's first vertex to its second
  };
  /// A side of a part.
  struct Step {
    int triangle, from, to;
  };

  void find_side_ends();
  bool add_side_steps(int tetrahedron);
  bool trace_parts();

  const SolidElements& elements_;
  const TriangleMesh& surface_;
  const EdgeTopology& surface_edges_;
  const SurfaceCrossings& crossings_;
  const std::vector<int>& first_segment_;
  const std::vector<SurfaceSegment>& segments_;
  std::vector<int> first_side_end_;  // |T| + 1
  std::vector<SideEnd> side_ends_;
  std::vector<Step> steps_;
  std::vector<SurfacePart> parts_;
};

}  // namespace shatterbox::geometry
