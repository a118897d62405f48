// The surface of a body as the audit sees it: triangles, edges, who owns which feature, and a tree of boxes
// of its own. Boxes are surfaces of twelve triangles.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "engine/body/shape.h"
#include "engine/core/vec.h"
#include "engine/geometry/edge_topology.h"
#include "engine/geometry/triangle_mesh.h"

namespace shatterbox::audit {

struct Bounds {
  Vec3 low = Vec3::Constant(1e300), high = Vec3::Constant(-1e300);  // m

  void include(const Vec3& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  void include(const Bounds& b) {
    low = low.cwiseMin(b.low);
    high = high.cwiseMax(b.high);
  }
  bool meets(const Bounds& b) const {
    return low.x() <= b.high.x() && b.low.x() <= high.x() && low.y() <= b.high.y() && b.low.y() <= high.y() &&
           low.z() <= b.high.z() && b.low.z() <= high.z();
  }
};

struct Surface {
  struct Node {
    int begin = 0, end = 0;     // triangles order[begin .. end)
    int left = -1, right = -1;  // children; -1 in leaves
  };

  std::shared_ptr<const body::Shape> shape;
  std::vector<Vec3> vertices;  // body space, m
  std::vector<geometry::Triangle> triangles;
  geometry::EdgeTopology topology;
  // Each vertex and edge belongs to one triangle, so that each feature is looked at once.
  std::vector<std::array<bool, 3>> owns_corner, owns_edge;
  std::vector<int> order;
  std::vector<Node> nodes;  // parents before children; the root is 0
};

/// None for planes and spheres, which have no triangles.
std::shared_ptr<const Surface> make_surface(const std::shared_ptr<const body::Shape>& shape);

/// A surface on its straight way from one pose to another.
struct MovingSurface {
  std::vector<Vec3> start, end;   // of the vertices, world, m
  std::vector<Bounds> triangles;  // of the triangles' ways
  std::vector<Bounds> nodes;      // of the nodes' ways
};

/// From positions of its vertices (|V| x 3, world, m) to others.
MovingSurface move_surface(const Surface& surface, std::vector<Vec3> start, std::vector<Vec3> end);

/// Positions of the vertices at a pose.
std::vector<Vec3> place_surface(const Surface& surface, const Pose& pose);

/// Stretches the boxes of `way` over `other`, which are of the same surface.
void include_way(const MovingSurface& other, MovingSurface& way);

}  // namespace shatterbox::audit
