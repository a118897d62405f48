#include "engine/collision/feature_list.h"

namespace shatterbox::collision {
namespace {

using geometry::Box;
using geometry::TriangleTree;

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

// The path of a vertex seen from its body's centre: a sphere about `path`'s box when the collider is a
// sphere.
struct Paths {
  const PlacedCollider* placed = nullptr;
  const std::vector<Vec3>* turned = nullptr;  // null: the start only
  Vec3 way = Vec3::Zero();                    // the body's centre moves by this in the other's frame

  Box vertex_box(int vertex) const {
    const Vec3& start = placed->start[at(vertex)];
    Box box{start, start};
    if (turned != nullptr) box.include((*turned)[at(vertex)]);
    if (placed->collider->radius > 0.0) {
      box.low.array() -= placed->collider->radius;
      box.high.array() += placed->collider->radius;
    }
    const Vec3 low = box.low + way, high = box.high + way;
    box.low = box.low.cwiseMin(low);
    box.high = box.high.cwiseMax(high);
    return box;
  }
  Box edge_box(int edge) const {
    const auto& [v, w] = placed->collider->edges[at(edge)];
    Box box = vertex_box(v);
    box.include(vertex_box(w));
    return box;
  }
  Box triangle_box(int triangle) const {
    const auto& t = placed->collider->triangles[at(triangle)];
    Box box = vertex_box(t[0]);
    box.include(vertex_box(t[1]));
    box.include(vertex_box(t[2]));
    return box;
  }
};

// Boxes of one leaf's features, made once a leaf pair.
struct LeafBoxes {
  std::vector<std::pair<int, Box>> triangles, vertices, edges;

  void fill(const Paths& paths, const TriangleTree::Node& leaf) {
    const Collider& c = *paths.placed->collider;
    triangles.clear();
    vertices.clear();
    edges.clear();
    for (int k = leaf.begin; k < leaf.begin + leaf.count; ++k) {
      const int t = c.tree.order[at(k)];
      triangles.emplace_back(t, paths.triangle_box(t));
      for (int i = c.owned_vertex_begin[at(t)]; i < c.owned_vertex_begin[at(t) + 1]; ++i) {
        const int v = c.owned_vertices[at(i)];
        vertices.emplace_back(v, paths.vertex_box(v));
      }
      for (int i = c.owned_edge_begin[at(t)]; i < c.owned_edge_begin[at(t) + 1]; ++i) {
        const int e = c.owned_edges[at(i)];
        edges.emplace_back(e, paths.edge_box(e));
      }
    }
  }
};

void add_overlapping(FeatureKind kind, const std::vector<std::pair<int, Box>>& as,
                     const std::vector<std::pair<int, Box>>& bs, double margin, FeatureList& out) {
  for (const auto& [a, box_a] : as) {
    for (const auto& [b, box_b] : bs) {
      if (geometry::overlaps(box_a, box_b, margin)) out.push_back({kind, a, b});
    }
  }
}

void list_features(const Paths& a, const std::vector<Box>& boxes_a, const Paths& b,
                   const std::vector<Box>& boxes_b, double margin, FeatureList& out) {
  out.clear();
  std::vector<std::pair<int, int>> stack;
  LeafBoxes leaf_a, leaf_b;
  const TriangleTree::Node* last_a = nullptr;
  const bool a_has_faces = a.placed->collider->radius == 0.0;
  const bool b_has_faces = b.placed->collider->radius == 0.0;
  geometry::for_each_leaf_pair(
      a.placed->collider->tree, boxes_a, b.placed->collider->tree, boxes_b, margin, stack,
      [&](const TriangleTree::Node& node_a, const TriangleTree::Node& node_b) {
        if (&node_a != last_a) leaf_a.fill(a, node_a);
        last_a = &node_a;
        leaf_b.fill(b, node_b);
        if (b_has_faces) {
          add_overlapping(FeatureKind::vertex_triangle, leaf_a.vertices, leaf_b.triangles, margin, out);
        }
        if (a_has_faces) {
          add_overlapping(FeatureKind::triangle_vertex, leaf_a.triangles, leaf_b.vertices, margin, out);
        }
        add_overlapping(FeatureKind::edge_edge, leaf_a.edges, leaf_b.edges, margin, out);
      });
}

}  // namespace

void refit_boxes(PlacedCollider& placed) {
  const Paths paths{&placed, nullptr, Vec3::Zero()};
  geometry::refit(
      placed.collider->tree, placed.collider->triangles, [&](int vertex) { return paths.vertex_box(vertex); },
      placed.boxes);
}

void refit_swept_boxes(PlacedCollider& placed, const std::vector<Vec3>& turned) {
  const Paths paths{&placed, &turned, Vec3::Zero()};
  geometry::refit(
      placed.collider->tree, placed.collider->triangles, [&](int vertex) { return paths.vertex_box(vertex); },
      placed.swept_boxes);
}

void list_near_features(const PlacedCollider& a, const PlacedCollider& b, double margin, FeatureList& out) {
  list_features({&a, nullptr, Vec3::Zero()}, a.boxes, {&b, nullptr, Vec3::Zero()}, b.boxes, margin, out);
}

void list_swept_features(const PlacedCollider& a, const std::vector<Vec3>& turned_a, const PlacedCollider& b,
                         const std::vector<Vec3>& turned_b, const Vec3& relative_way, double margin,
                         FeatureList& out) {
  std::vector<Box> moved = b.swept_boxes;
  for (Box& box : moved) {
    const Vec3 low = box.low + relative_way, high = box.high + relative_way;
    box.low = box.low.cwiseMin(low);
    box.high = box.high.cwiseMax(high);
  }
  list_features({&a, &turned_a, Vec3::Zero()}, a.swept_boxes, {&b, &turned_b, relative_way}, moved, margin,
                out);
}

}  // namespace shatterbox::collision
