// What collision needs of a shape, built once: features (vertices, edges, triangles), who is whose neighbour,
// and the triangle tree. Shells, solids, boxes, spheres and capsules are all seen as features: a sphere is
// one vertex with a radius, a capsule one edge with a radius.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "engine/body/shape.h"
#include "engine/core/vec.h"
#include "engine/geometry/bvh.h"
#include "engine/geometry/triangle_mesh.h"

namespace shatterbox::collision {

struct Collider {
  body::ShapeKind kind = body::ShapeKind::shell;
  std::vector<Vec3> vertices;                      // |V| x 3, body space, m
  std::vector<geometry::Triangle> triangles;       // |T| x 3; a sphere has one that is its centre thrice, a
                                                   // capsule one of its two ends
  std::vector<std::array<int, 2>> edges;           // |E| x 2
  std::vector<std::array<int, 3>> triangle_edges;  // |T| x 3: edge i joins corners i and (i + 1) % 3
  std::vector<int> neighbour_begin;                // |V| + 1
  std::vector<int> neighbours;                     // vertices that share an edge with a vertex
  std::vector<int> opposite_begin;                 // |E| + 1
  std::vector<int> opposites;                      // the third vertices of an edge's triangles
  // Every vertex, and every edge that can touch alone, is owned by one of its triangles, so that each feature
  // pair is met once.
  std::vector<int> owned_vertex_begin, owned_vertices;  // |T| + 1
  std::vector<int> owned_edge_begin, owned_edges;       // |T| + 1
  geometry::TriangleTree tree;
  std::vector<int> leaf_vertex_begin, leaf_vertices;  // |nodes| + 1: those of a leaf's triangles, each once
  geometry::Box box;                                  // of the vertices, radius included, body space
  double radius = 0.0;           // about the vertices and edges of spheres and capsules, m
  double bounding_radius = 0.0;  // about the origin, m, radius included
};

/// How the vertices of a surface move: as one body does, on straight ways between two of its poses at most;
/// or each as it likes.
enum class SurfaceMotion { rigid, free };

/// Builds the collider of a shape; a plane has no features. Of a surface that moves rigidly triangles own
/// exposed edges only (exposed_edges.h).
std::shared_ptr<const Collider> make_collider(const body::Shape& shape,
                                              SurfaceMotion motion = SurfaceMotion::rigid);

}  // namespace shatterbox::collision
