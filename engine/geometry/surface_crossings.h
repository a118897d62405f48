// Where a closed surface meets a mesh of tetrahedra: which of the mesh's edges pass through which triangles,
// which of the surface's edges pass through which faces, and what lies inside. Exact [She97]; touching is
// decided by one rule (orientation.h), so that everything fits together.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/core/result.h"
#include "engine/geometry/edge_topology.h"
#include "engine/geometry/solid_mesh.h"
#include "engine/geometry/triangle_mesh.h"

namespace shatterbox::geometry {

/// An edge of the mesh passes through a triangle of the surface.
struct EdgeCrossing {
  int triangle = 0;
  bool enters = false;  // the inside of the surface, on the way from the edge's first vertex to its second
};

/// An edge of the surface passes through a face of the mesh.
struct FaceCrossing {
  int edge = 0;     // of the surface
  int passage = 0;  // from the edge's first vertex to its second: 1 to the side from which the face's corners
                    // (ascending) turn counter-clockwise, -1 away from it
};

struct SurfaceCrossings {
  std::vector<std::uint8_t> is_inside;       // |V|: the mesh's vertex lies inside the surface
  std::vector<int> first_edge_crossing;      // |E| + 1
  std::vector<EdgeCrossing> edge_crossings;  // of all edges; within one in their order along it
  std::vector<int> first_face_crossing;      // |F| + 1
  std::vector<FaceCrossing> face_crossings;  // of all faces; within one by the surface's edge
  std::vector<int> vertex_tetrahedron;       // per vertex of the surface: where it lies; -1 outside the mesh

  /// True if some of the surface's inside is in the tetrahedron.
  std::vector<std::uint8_t> has_material;  // |T|
};

/// The crossings of `surface` (closed, wound counter-clockwise seen from outside, not crossing itself) with
/// the mesh. An error sentence where in and out do not take turns along an edge of the mesh: the surface
/// crosses itself there.
core::Result<SurfaceCrossings> find_surface_crossings(const SolidElements& elements,
                                                      const TriangleMesh& surface,
                                                      const EdgeTopology& surface_edges);

}  // namespace shatterbox::geometry
