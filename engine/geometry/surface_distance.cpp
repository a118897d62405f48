#include "engine/geometry/surface_distance.h"

#include <utility>

#include "engine/core/elementary.h"
#include "engine/core/index.h"
#include "engine/geometry/closest_points.h"

namespace shatterbox::geometry {

using core::at;

SurfaceDistance::SurfaceDistance(const TriangleMesh& surface)
    : surface_(surface),
      tree_(build_triangle_tree(surface.positions, surface.triangles)),
      boxes_(node_boxes(tree_, surface)) {}

NearestPlace SurfaceDistance::find(const Vec3& p, double radius) const {
  NearestPlace nearest;
  nearest.distance = radius;
  if (tree_.nodes.empty()) return nearest;
  struct Entry {
    int node;
    double distance_squared;
  };
  std::vector<Entry> stack{{0, squared_distance(boxes_[0], p)}};
  while (!stack.empty()) {
    const Entry entry = stack.back();
    stack.pop_back();
    if (entry.distance_squared > nearest.distance * nearest.distance) continue;
    const TriangleTree::Node& node = tree_.nodes[at(entry.node)];
    for (int i = node.begin; i < node.begin + node.count; ++i) {
      const int t = tree_.order[at(i)];
      const Triangle& corners = surface_.triangles[at(t)];
      const PointTriangle found =
          closest_on_triangle(p, surface_.positions[at(corners[0])], surface_.positions[at(corners[1])],
                              surface_.positions[at(corners[2])]);
      if (found.distance > nearest.distance || (found.distance == nearest.distance && nearest.triangle >= 0))
        continue;
      nearest = {t, found.closest, found.distance};
    }
    if (node.count > 0) continue;
    Entry near{entry.node + 1, squared_distance(boxes_[at(entry.node + 1)], p)};
    Entry far{node.right, squared_distance(boxes_[at(node.right)], p)};
    if (far.distance_squared < near.distance_squared) std::swap(near, far);
    stack.push_back(far);
    stack.push_back(near);
  }
  return nearest;
}

}  // namespace shatterbox::geometry
