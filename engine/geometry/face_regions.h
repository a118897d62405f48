// The material on one face of a mesh of tetrahedra: the face's inside of the given surface, as convex
// polygons over global vertices. For embedded_material.cpp.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "engine/geometry/surface_crossings.h"

namespace shatterbox::geometry {

/// Vertices of the complex, by what they come from: those of the surface first, then the mesh's, then the
/// places where edges of the mesh pass triangles, and where edges of the surface pass faces.
struct CrossingVertices {
  int first_mesh = 0;
  int first_edge = 0;
  int first_face = 0;
  int count = 0;
};
CrossingVertices number_vertices(const SolidElements& elements, const TriangleMesh& surface,
                                 const SurfaceCrossings& crossings);

/// Their positions; of those that are not in use, too.
std::vector<Vec3> place_vertices(const SolidElements& elements, const TriangleMesh& surface,
                                 const EdgeTopology& surface_edges, const SurfaceCrossings& crossings);

/// What a triangle of the surface and a face of the mesh have in common, with the material on its left seen
/// from outside of the face's first tetrahedron.
struct SurfaceSegment {
  int triangle = 0;
  int from = 0, to = 0;
};

class FaceRegions {
 public:
  FaceRegions(const SolidElements& elements, const TriangleMesh& surface, const EdgeTopology& surface_edges,
              const SurfaceCrossings& crossings, const std::vector<Vec3>& positions);

  /// Finds segments() and polygons() of a face. False if what crosses it does not fit together.
  bool find(int face);

  const std::vector<SurfaceSegment>& segments() const { return segments_; }
  /// Counter-clockwise seen from outside of the face's first tetrahedron.
  const std::vector<std::vector<int>>& polygons() const { return polygons_; }
  /// The face itself is the only polygon.
  bool is_whole() const { return is_whole_; }

 private:
  struct End {
    int triangle, vertex;
    bool is_start;
  };

  bool find_segments(int face, int direction);
  void walk_border(int face, int direction);
  bool trace_loops();

  const SolidElements& elements_;
  const TriangleMesh& surface_;
  const EdgeTopology& surface_edges_;
  const SurfaceCrossings& crossings_;
  const std::vector<Vec3>& positions_;
  CrossingVertices vertices_;
  std::vector<End> ends_;
  std::vector<SurfaceSegment> segments_;
  std::vector<std::pair<int, int>> next_;  // (vertex, the one after it on its loop), by vertex
  std::vector<std::vector<int>> loops_, polygons_;
  bool is_whole_ = false;
};

}  // namespace shatterbox::geometry
