#include "engine/collision/feature_list.h"

namespace shatterbox::collision {
namespace {

using geometry::Box;
using geometry::TriangleTree;

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

Box moved_along(const Box& box, const Vec3& way) {
  return {box.low + way.cwiseMin(0.0), box.high + way.cwiseMax(0.0)};
}

// One side of a descent: boxes of vertices and of tree nodes, all moved along `way`.
struct Side {
  const Collider& collider;
  const std::vector<Box>& vertex_boxes;
  Vec3 way = Vec3::Zero();

  Box vertex_box(int vertex) const { return moved_along(vertex_boxes[at(vertex)], way); }
  Box edge_box(int edge) const {
    const auto& [v, w] = collider.edges[at(edge)];
    Box box = vertex_boxes[at(v)];
    box.include(vertex_boxes[at(w)]);
    return moved_along(box, way);
  }
  Box triangle_box(int triangle) const {
    const auto& t = collider.triangles[at(triangle)];
    Box box = vertex_boxes[at(t[0])];
    box.include(vertex_boxes[at(t[1])]);
    box.include(vertex_boxes[at(t[2])]);
    return moved_along(box, way);
  }
};

using NumberedBoxes = std::vector<std::pair<int, Box>>;

// Features of one leaf that come within the margin of the other leaf's box.
struct LeafFeatures {
  NumberedBoxes triangles, vertices, edges;

  void fill(const Side& side, const TriangleTree::Node& leaf, const Box& other, double margin) {
    const Collider& c = side.collider;
    triangles.clear();
    vertices.clear();
    edges.clear();
    const auto add = [&](NumberedBoxes& boxes, int number, const Box& box) {
      if (geometry::overlaps(box, other, margin)) boxes.emplace_back(number, box);
    };
    for (int k = leaf.begin; k < leaf.begin + leaf.count; ++k) {
      const int t = c.tree.order[at(k)];
      const Box box = side.triangle_box(t);
      if (!geometry::overlaps(box, other, margin)) continue;  // and neither does what it owns
      triangles.emplace_back(t, box);
      for (int i = c.owned_vertex_begin[at(t)]; i < c.owned_vertex_begin[at(t) + 1]; ++i) {
        const int v = c.owned_vertices[at(i)];
        add(vertices, v, side.vertex_box(v));
      }
      for (int i = c.owned_edge_begin[at(t)]; i < c.owned_edge_begin[at(t) + 1]; ++i) {
        const int e = c.owned_edges[at(i)];
        add(edges, e, side.edge_box(e));
      }
    }
  }
};

void add_overlapping(FeatureKind kind, const NumberedBoxes& as, const NumberedBoxes& bs, double margin,
                     FeatureList& out) {
  for (const auto& [a, box_a] : as) {
    for (const auto& [b, box_b] : bs) {
      if (geometry::overlaps(box_a, box_b, margin)) out.push_back({kind, a, b, 0.0});
    }
  }
}

void list_features(const Side& a, const std::vector<Box>& boxes_a, const Side& b,
                   const std::vector<Box>& boxes_b, double margin, FeatureList& out) {
  out.clear();
  std::vector<std::pair<int, int>> stack;
  LeafFeatures leaf_a, leaf_b;
  const bool a_has_faces = a.collider.radius == 0.0, b_has_faces = b.collider.radius == 0.0;
  geometry::for_each_leaf_pair(
      a.collider.tree, boxes_a, b.collider.tree, boxes_b, margin, stack,
      [&](const TriangleTree::Node& node_a, const TriangleTree::Node& node_b) {
        const auto number = [](const Collider& c, const TriangleTree::Node& node) {
          return static_cast<std::size_t>(&node - c.tree.nodes.data());
        };
        leaf_a.fill(a, node_a, boxes_b[number(b.collider, node_b)], margin);
        if (leaf_a.triangles.empty()) return;
        leaf_b.fill(b, node_b, boxes_a[number(a.collider, node_a)], margin);
        if (b_has_faces) {
          add_overlapping(FeatureKind::vertex_triangle, leaf_a.vertices, leaf_b.triangles, margin, out);
        }
        if (a_has_faces) {
          add_overlapping(FeatureKind::triangle_vertex, leaf_a.triangles, leaf_b.vertices, margin, out);
        }
        add_overlapping(FeatureKind::edge_edge, leaf_a.edges, leaf_b.edges, margin, out);
      });
}

void refit_tree(const Collider& collider, const std::vector<Box>& vertex_boxes, std::vector<Box>& boxes) {
  geometry::refit(
      collider.tree, collider.triangles, [&](int v) -> const Box& { return vertex_boxes[at(v)]; }, boxes);
}

}  // namespace

void refit_boxes(PlacedCollider& placed) {
  const Vec3 radius = Vec3::Constant(placed.collider->radius);
  placed.vertex_boxes.clear();
  for (const Vec3& p : placed.start) placed.vertex_boxes.push_back({p - radius, p + radius});
  refit_tree(*placed.collider, placed.vertex_boxes, placed.boxes);
}

void refit_swept_boxes(PlacedCollider& placed, const std::vector<Vec3>& turned) {
  const Vec3 radius = Vec3::Constant(placed.collider->radius);
  placed.swept_vertex_boxes.clear();
  for (std::size_t v = 0; v < placed.start.size(); ++v) {
    const Vec3 &p = placed.start[v], &q = turned[v];
    placed.swept_vertex_boxes.push_back({p.cwiseMin(q) - radius, p.cwiseMax(q) + radius});
  }
  refit_tree(*placed.collider, placed.swept_vertex_boxes, placed.swept_boxes);
}

void list_near_features(const PlacedCollider& a, const PlacedCollider& b, double margin, FeatureList& out) {
  list_features({*a.collider, a.vertex_boxes}, a.boxes, {*b.collider, b.vertex_boxes}, b.boxes, margin, out);
}

void list_swept_features(const PlacedCollider& a, const PlacedCollider& b, const Vec3& relative_way,
                         double margin, FeatureList& out) {
  out.clear();
  if (a.swept_boxes.empty() || b.swept_boxes.empty() ||
      !geometry::overlaps(a.swept_boxes[0], moved_along(b.swept_boxes[0], relative_way), margin)) {
    return;
  }
  std::vector<Box> moved;
  moved.reserve(b.swept_boxes.size());
  for (const Box& box : b.swept_boxes) moved.push_back(moved_along(box, relative_way));
  list_features({*a.collider, a.swept_vertex_boxes}, a.swept_boxes,
                {*b.collider, b.swept_vertex_boxes, relative_way}, moved, margin, out);
}

}  // namespace shatterbox::collision
