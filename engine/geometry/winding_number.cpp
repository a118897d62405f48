#include "engine/geometry/winding_number.h"

#include <algorithm>
#include <array>

#include "engine/core/elementary.h"
#include "engine/core/index.h"

namespace shatterbox::geometry {
namespace {

using Size = std::size_t;
using core::at;

constexpr double kFar = 3.0;  // radii of a cluster, beyond which it is seen as one
constexpr int kDeepest = 64;  // of a tree that halves its triangles
constexpr double kWhole = 4.0 * core::kPi;

}  // namespace

WindingNumber::WindingNumber(const TriangleMesh& surface)
    : surface_(surface), tree_(build_triangle_tree(surface.positions, surface.triangles)) {
  clusters_.resize(tree_.nodes.size());
  std::vector<double> areas(clusters_.size(), 0.0);
  const std::vector<Box> boxes = node_boxes(tree_, surface);
  for (Size n = clusters_.size(); n-- > 0;) {
    const TriangleTree::Node& node = tree_.nodes[n];
    Cluster& cluster = clusters_[n];
    Vec3 moment = Vec3::Zero();
    const auto add = [&](const Vec3& centre, const Vec3& area_vector, double area) {
      moment += area * centre;
      cluster.area_vector += area_vector;
      areas[n] += area;
    };
    for (int k = node.begin; k < node.begin + node.count; ++k) {
      const Triangle& t = surface.triangles[at(tree_.order[at(k)])];
      const Vec3 &a = surface.positions[at(t[0])], &b = surface.positions[at(t[1])],
                 &c = surface.positions[at(t[2])];
      const Vec3 area_vector = 0.5 * (b - a).cross(c - a);
      add((a + b + c) / 3.0, area_vector, area_vector.norm());
    }
    if (node.count == 0)
      for (const Size child : {n + 1, static_cast<Size>(node.right)})
        add(clusters_[child].centre, clusters_[child].area_vector, areas[child]);
    cluster.centre = areas[n] > 0.0 ? Vec3(moment / areas[n]) : Vec3(0.5 * (boxes[n].low + boxes[n].high));
    const Vec3 reach = (cluster.centre - boxes[n].low).cwiseMax(boxes[n].high - cluster.centre);
    cluster.radius = reach.norm();
  }
}

/// The solid angle under which it is seen [VOS83], over 4 pi.
double WindingNumber::of_triangle(int triangle, const Vec3& p) const {
  const Triangle& t = surface_.triangles[at(triangle)];
  const Vec3 a = surface_.positions[at(t[0])] - p, b = surface_.positions[at(t[1])] - p,
             c = surface_.positions[at(t[2])] - p;
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  const double below = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
  return 2.0 * core::atan2(a.dot(b.cross(c)), below) / kWhole;
}

double WindingNumber::about(const Vec3& p) const {
  if (tree_.nodes.empty()) return 0.0;
  std::array<int, kDeepest> stack;
  int waiting = 0;
  stack[at(waiting++)] = 0;
  double sum = 0.0;
  while (waiting > 0) {
    const int n = stack[at(--waiting)];
    const Cluster& cluster = clusters_[at(n)];
    const Vec3 way = cluster.centre - p;
    const double distance_squared = way.squaredNorm();
    const double far = kFar * cluster.radius;
    if (distance_squared > far * far) {
      sum += way.dot(cluster.area_vector) / (kWhole * distance_squared * core::sqrt(distance_squared));
      continue;
    }
    const TriangleTree::Node& node = tree_.nodes[at(n)];
    for (int k = node.begin; k < node.begin + node.count; ++k) sum += of_triangle(tree_.order[at(k)], p);
    if (node.count > 0) continue;
    stack[at(waiting++)] = node.right;
    stack[at(waiting++)] = n + 1;
  }
  return sum;
}

}  // namespace shatterbox::geometry
