// A tree of boxes over the triangles of a mesh. Its shape (who is whose child) is built once, in body space;
// the boxes are refitted to wherever the vertices are, or to the paths that they take.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "engine/core/vec.h"
#include "engine/geometry/triangle_mesh.h"

namespace shatterbox::geometry {

/// An axis-aligned box; empty as made.
struct Box {
  Vec3 low = Vec3::Constant(1e300);    // m
  Vec3 high = Vec3::Constant(-1e300);  // m

  void include(const Vec3& point) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  void include(const Box& other) {
    low = low.cwiseMin(other.low);
    high = high.cwiseMax(other.high);
  }
};

/// True if the boxes, one of them grown by `margin` on all sides, share a point.
inline bool overlaps(const Box& a, const Box& b, double margin = 0.0) {
  return a.low.x() <= b.high.x() + margin && b.low.x() <= a.high.x() + margin &&
         a.low.y() <= b.high.y() + margin && b.low.y() <= a.high.y() + margin &&
         a.low.z() <= b.high.z() + margin && b.low.z() <= a.high.z() + margin;
}

/// m2, from a point to the nearest one of the box.
inline double squared_distance(const Box& box, const Vec3& p) {
  return (box.low - p).cwiseMax(p - box.high).cwiseMax(0.0).squaredNorm();
}

/// About all vertices.
inline Box box_of(const TriangleMesh& mesh) {
  Box box;
  for (const Vec3& p : mesh.positions) box.include(p);
  return box;
}

struct TriangleTree {
  struct Node {
    int right = 0;  // number of the second child; the first follows its parent. Unused in leaves
    int begin = 0;  // leaves: their triangles are order[begin .. begin + count)
    int count = 0;  // 0 for inner nodes
  };
  std::vector<Node> nodes;  // depth first; the root is node 0
  std::vector<int> order;   // |T|, a permutation of the triangles
};

/// Triangles that a leaf holds at most.
inline constexpr std::size_t kLeafSize = 4;

/// Builds the tree of `triangles` (|T| x 3) by median splits of their centres. No triangles give no nodes.
TriangleTree build_triangle_tree(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles);

/// Boxes of all nodes (|nodes|) from boxes of the vertices (|V|), by `vertex_box(vertex)`.
template <class VertexBox>
void refit(const TriangleTree& tree, const std::vector<Triangle>& triangles, const VertexBox& vertex_box,
           std::vector<Box>& boxes) {
  boxes.resize(tree.nodes.size());
  for (int i = static_cast<int>(tree.nodes.size()) - 1; i >= 0; --i) {
    const auto& node = tree.nodes[static_cast<std::size_t>(i)];
    Box box;
    for (int k = node.begin; k < node.begin + node.count; ++k) {
      const auto& triangle = triangles[static_cast<std::size_t>(tree.order[static_cast<std::size_t>(k)])];
      for (const int vertex : triangle) box.include(vertex_box(vertex));
    }
    if (node.count == 0) {
      box = boxes[static_cast<std::size_t>(i) + 1];
      box.include(boxes[static_cast<std::size_t>(node.right)]);
    }
    boxes[static_cast<std::size_t>(i)] = box;
  }
}

/// The same of a mesh where it is.
std::vector<Box> node_boxes(const TriangleTree& tree, const TriangleMesh& mesh);
/// Of its triangles.
std::vector<Box> triangle_boxes(const TriangleMesh& mesh);

/// Calls visit(leaf_a, leaf_b) for all pairs of leaves whose boxes come within `margin`, in an order that
/// depends on the trees alone. `stack` is scratch.
template <class Visit>
void for_each_leaf_pair(const TriangleTree& tree_a, const std::vector<Box>& boxes_a,
                        const TriangleTree& tree_b, const std::vector<Box>& boxes_b, double margin,
                        std::vector<std::pair<int, int>>& stack, const Visit& visit) {
  if (tree_a.nodes.empty() || tree_b.nodes.empty()) return;
  stack.assign(1, {0, 0});
  while (!stack.empty()) {
    const auto [a, b] = stack.back();
    stack.pop_back();
    const Box& box_a = boxes_a[static_cast<std::size_t>(a)];
    const Box& box_b = boxes_b[static_cast<std::size_t>(b)];
    if (!overlaps(box_a, box_b, margin)) continue;
    const auto& node_a = tree_a.nodes[static_cast<std::size_t>(a)];
    const auto& node_b = tree_b.nodes[static_cast<std::size_t>(b)];
    if (node_a.count > 0 && node_b.count > 0) {
      visit(node_a, node_b);
    } else if (node_b.count > 0 ||
               (node_a.count == 0 && (box_a.high - box_a.low).sum() >= (box_b.high - box_b.low).sum())) {
      stack.push_back({node_a.right, b});
      stack.push_back({a + 1, b});
    } else {
      stack.push_back({a, node_b.right});
      stack.push_back({a, b + 1});
    }
  }
}

}  // namespace shatterbox::geometry
