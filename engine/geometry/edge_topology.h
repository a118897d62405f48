// Edges of a triangle mesh and who shares them. Edges are numbered by their sorted vertex pairs, so the
// numbers depend on the mesh alone.
#pragma once

#include <array>
#include <vector>

#include "engine/geometry/triangle_mesh.h"

namespace shatterbox::geometry {

struct EdgeTopology {
  std::vector<std::array<int, 2>> edges;           // |E| x 2, first vertex < second, in lexicographic order
  std::vector<std::array<int, 3>> triangle_edges;  // |T| x 3: edge i joins corner i and corner (i + 1) % 3
  std::vector<int> first_triangle;  // |E| + 1: begin of an edge's triangles in `edge_triangles`
  std::vector<int> edge_triangles;  // triangles of all edges, ascending within an edge

  int triangle_count(int edge) const {
    return first_triangle[static_cast<std::size_t>(edge) + 1] -
           first_triangle[static_cast<std::size_t>(edge)];
  }
  bool is_boundary(int edge) const { return triangle_count(edge) == 1; }
};

/// Edges of `triangles` (|T| x 3 vertex numbers). Any manifoldness; an edge may have one, two or more
/// triangles.
EdgeTopology build_edge_topology(const std::vector<Triangle>& triangles);

/// 1 if a triangle runs along its edge from the edge's first vertex to the second, -1 otherwise.
int direction_along(const Triangle& triangle, const std::array<int, 2>& edge);

}  // namespace shatterbox::geometry
