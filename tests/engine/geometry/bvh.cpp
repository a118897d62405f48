#include "engine/geometry/bvh.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

#include "engine/core/random.h"

namespace shatterbox::geometry {
namespace {

TriangleMesh soup(std::uint64_t seed, int count, const Vec3& centre) {
  core::Random random(seed);
  TriangleMesh mesh;
  for (int t = 0; t < count; ++t) {
    Vec3 middle;
    for (int i = 0; i < 3; ++i) middle[i] = random.uniform(-1, 1);
    for (int k = 0; k < 3; ++k) {
      Vec3 offset;
      for (int i = 0; i < 3; ++i) offset[i] = random.uniform(-0.1, 0.1);
      mesh.positions.push_back(centre + middle + offset);
    }
    mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  return mesh;
}

Box box_of(const TriangleMesh& mesh, int triangle) {
  Box box;
  for (const int v : mesh.triangles[static_cast<std::size_t>(triangle)]) {
    box.include(mesh.positions[static_cast<std::size_t>(v)]);
  }
  return box;
}

}  // namespace

TEST_CASE("the tree holds every triangle once, in boxes that contain it") {
  const TriangleMesh mesh = soup(1, 137, Vec3::Zero());
  const TriangleTree tree = build_triangle_tree(mesh.positions, mesh.triangles);
  std::vector<int> order = tree.order;
  std::sort(order.begin(), order.end());
  for (int i = 0; i < 137; ++i) CHECK(order[static_cast<std::size_t>(i)] == i);
  int in_leaves = 0;
  for (const auto& node : tree.nodes) in_leaves += node.count;
  CHECK(in_leaves == 137);
  CHECK(build_triangle_tree({}, {}).nodes.empty());
}

TEST_CASE("the descent meets all pairs of triangles that are near, each once") {
  const TriangleMesh a = soup(2, 90, Vec3::Zero()), b = soup(3, 60, Vec3(0.5, 0.3, 0.0));
  const TriangleTree tree_a = build_triangle_tree(a.positions, a.triangles);
  const TriangleTree tree_b = build_triangle_tree(b.positions, b.triangles);
  const auto boxes = [](const TriangleMesh& mesh, const TriangleTree& tree) {
    std::vector<Box> result;
    refit(
        tree, mesh.triangles,
        [&](int v) {
          const Vec3& p = mesh.positions[static_cast<std::size_t>(v)];
          return Box{p, p};
        },
        result);
    return result;
  };
  const double margin = 0.05;
  std::set<std::pair<int, int>> met;
  bool met_twice = false;
  std::vector<std::pair<int, int>> stack;
  for_each_leaf_pair(tree_a, boxes(a, tree_a), tree_b, boxes(b, tree_b), margin, stack,
                     [&](const TriangleTree::Node& na, const TriangleTree::Node& nb) {
                       for (int i = na.begin; i < na.begin + na.count; ++i) {
                         for (int j = nb.begin; j < nb.begin + nb.count; ++j) {
                           met_twice |= !met.insert({tree_a.order[static_cast<std::size_t>(i)],
                                                     tree_b.order[static_cast<std::size_t>(j)]})
                                             .second;
                         }
                       }
                     });
  CHECK(!met_twice);
  CHECK(met.size() < 90 * 60 / 2);
  for (int i = 0; i < 90; ++i) {
    for (int j = 0; j < 60; ++j) {
      if (overlaps(box_of(a, i), box_of(b, j), margin)) CHECK(met.count({i, j}) == 1);
    }
  }
}

}  // namespace shatterbox::geometry
