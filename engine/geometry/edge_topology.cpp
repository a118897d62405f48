#include "engine/geometry/edge_topology.h"

#include <algorithm>

namespace shatterbox::geometry {

EdgeTopology build_edge_topology(const std::vector<Triangle>& triangles) {
  struct Side {
    int low, high, triangle, corner;
  };
  std::vector<Side> sides;
  sides.reserve(3 * triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i) {
      const int a = triangles[t][i];
      const int b = triangles[t][(i + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), static_cast<int>(t), static_cast<int>(i)});
    }
  std::sort(sides.begin(), sides.end(), [](const Side& p, const Side& q) {
    return std::array{p.low, p.high, p.triangle, p.corner} < std::array{q.low, q.high, q.triangle, q.corner};
  });

  EdgeTopology topology;
  topology.triangle_edges.resize(triangles.size());
  for (std::size_t s = 0; s < sides.size(); ++s) {
    const Side& side = sides[s];
    const bool is_new = s == 0 || side.low != sides[s - 1].low || side.high != sides[s - 1].high;
    if (is_new) {
      topology.edges.push_back({side.low, side.high});
      topology.first_triangle.push_back(static_cast<int>(s));
    }
    topology.edge_triangles.push_back(side.triangle);
    topology.triangle_edges[static_cast<std::size_t>(side.triangle)][static_cast<std::size_t>(side.corner)] =
        static_cast<int>(topology.edges.size()) - 1;
  }
  topology.first_triangle.push_back(static_cast<int>(sides.size()));
  return topology;
}

int direction_along(const Triangle& triangle, const std::array<int, 2>& edge) {
  for (std::size_t i = 0; i < 3; ++i)
    if (triangle[i] == edge[0] && triangle[(i + 1) % 3] == edge[1]) return 1;
  return -1;
}

}  // namespace shatterbox::geometry
