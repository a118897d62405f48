#include "engine/geometry/bvh.h"

#include <algorithm>
#include <numeric>

namespace shatterbox::geometry {
namespace {

/// A triangle's centre along the axis that is split, and the triangle.
struct MedianPlace {
  double along = 0.0;
  int triangle = 0;

  bool operator<(const MedianPlace& other) const {
    return along < other.along || (along == other.along && triangle < other.triangle);
  }
};

struct Builder {
  const std::vector<Vec3>& centres;
  TriangleTree& tree;
  std::vector<MedianPlace> places;  // |T|, scratch

  static bool is_leaf(int count) { return static_cast<std::size_t>(count) <= kLeafSize; }

  void build(int begin, int end) {
    const std::size_t index = tree.nodes.size();
    tree.nodes.emplace_back();
    tree.nodes[index].begin = begin;
    if (is_leaf(end - begin)) {
      tree.nodes[index].count = end - begin;
      return;
    }
    Box box;
    for (int i = begin; i < end; ++i) box.include(centre(i));
    int axis = 0;
    (box.high - box.low).maxCoeff(&axis);
    for (int i = begin; i < end; ++i)
      places[static_cast<std::size_t>(i)] = {centre(i)[axis], tree.order[static_cast<std::size_t>(i)]};
    const int middle = begin + (end - begin) / 2;
    const auto first = places.begin() + begin, half = places.begin() + middle, last = places.begin() + end;
    std::nth_element(first, half, last);
    // What is no leaf is put in order by its own axis.
    if (is_leaf(middle - begin)) std::sort(first, half);
    if (is_leaf(end - middle)) std::sort(half, last);
    for (int i = begin; i < end; ++i)
      tree.order[static_cast<std::size_t>(i)] = places[static_cast<std::size_t>(i)].triangle;
    build(begin, middle);
    tree.nodes[index].right = static_cast<int>(tree.nodes.size());
    build(middle, end);
  }

  const Vec3& centre(int place) const {
    return centres[static_cast<std::size_t>(tree.order[static_cast<std::size_t>(place)])];
  }
};

}  // namespace

TriangleTree build_triangle_tree(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles) {
  TriangleTree tree;
  if (triangles.empty()) return tree;
  std::vector<Vec3> centres;
  centres.reserve(triangles.size());
  for (const auto& t : triangles) {
    centres.push_back((positions[static_cast<std::size_t>(t[0])] + positions[static_cast<std::size_t>(t[1])] +
                       positions[static_cast<std::size_t>(t[2])]) /
                      3.0);
  }
  tree.order.resize(triangles.size());
  std::iota(tree.order.begin(), tree.order.end(), 0);
  tree.nodes.reserve(2 * triangles.size() / kLeafSize + 2);
  Builder{centres, tree, std::vector<MedianPlace>(triangles.size())}.build(
      0, static_cast<int>(triangles.size()));
  return tree;
}

std::vector<Box> node_boxes(const TriangleTree& tree, const TriangleMesh& mesh) {
  const auto vertex_box = [&](int vertex) {
    Box box;
    box.include(mesh.positions[static_cast<std::size_t>(vertex)]);
    return box;
  };
  std::vector<Box> boxes;
  refit(tree, mesh.triangles, vertex_box, boxes);
  return boxes;
}

std::vector<Box> triangle_boxes(const TriangleMesh& mesh) {
  std::vector<Box> boxes(mesh.triangles.size());
  for (std::size_t t = 0; t < boxes.size(); ++t)
    for (const int v : mesh.triangles[t]) boxes[t].include(mesh.positions[static_cast<std::size_t>(v)]);
  return boxes;
}

}  // namespace shatterbox::geometry
