#include "engine/geometry/bvh.h"

#include <numeric>

namespace shatterbox::geometry {
namespace {

struct Builder {
  const std::vector<Vec3>& centres;
  TriangleTree& tree;
  int leaf_size;

  void build(int begin, int end) {
    const std::size_t index = tree.nodes.size();
    tree.nodes.emplace_back();
    tree.nodes[index].begin = begin;
    if (end - begin <= leaf_size) {
      tree.nodes[index].count = end - begin;
      return;
    }
    Box box;
    for (int i = begin; i < end; ++i) box.include(centre(i));
    int axis = 0;
    (box.high - box.low).maxCoeff(&axis);
    std::sort(tree.order.begin() + begin, tree.order.begin() + end, [&](int a, int b) {
      const double xa = centres[static_cast<std::size_t>(a)][axis],
                   xb = centres[static_cast<std::size_t>(b)][axis];
      return xa < xb || (xa == xb && a < b);
    });
    const int middle = begin + (end - begin) / 2;
    build(begin, middle);
    tree.nodes[index].right = static_cast<int>(tree.nodes.size());
    build(middle, end);
  }

  const Vec3& centre(int place) const {
    return centres[static_cast<std::size_t>(tree.order[static_cast<std::size_t>(place)])];
  }
};

}  // namespace

TriangleTree build_triangle_tree(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles,
                                 int leaf_size) {
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
  tree.nodes.reserve(2 * triangles.size() / static_cast<std::size_t>(leaf_size) + 2);
  Builder{centres, tree, leaf_size}.build(0, static_cast<int>(triangles.size()));
  return tree;
}

}  // namespace shatterbox::geometry
