#include "engine/geometry/self_crossings.h"

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>
#include <vector>

#include "engine/core/index.h"
#include "engine/geometry/bvh.h"
#include "engine/geometry/orientation.h"

namespace shatterbox::geometry {
namespace {

using Size = std::size_t;
using core::at;

class SelfCrossingSearch {
 public:
  explicit SelfCrossingSearch(const TriangleMesh& mesh)
      : mesh_(mesh),
        tree_(build_triangle_tree(mesh.positions, mesh.triangles)),
        boxes_(node_boxes(tree_, mesh)),
        triangle_boxes_(triangle_boxes(mesh)) {}

  SelfCrossings run() {
    std::vector<std::pair<int, int>> stack, pairs;
    for_each_leaf_pair(tree_, boxes_, tree_, boxes_, 0.0, stack,
                       [&](const TriangleTree::Node& a, const TriangleTree::Node& b) {
                         for (int i = a.begin; i < a.begin + a.count; ++i)
                           for (int k = b.begin; k < b.begin + b.count; ++k)
                             test(tree_.order[at(i)], tree_.order[at(k)], pairs);
                       });
    SelfCrossings crossings;
    if (pairs.empty()) return crossings;
    crossings.count = static_cast<int>(pairs.size());
    std::tie(crossings.first_triangle, crossings.second_triangle) =
        *std::min_element(pairs.begin(), pairs.end());
    crossings.place = place_of(crossings.first_triangle, crossings.second_triangle);
    return crossings;
  }

 private:
  const Vec3& position(int v) const { return mesh_.positions[at(v)]; }

  void test(int first, int second, std::vector<std::pair<int, int>>& pairs) const {
    if (first >= second || !overlaps(triangle_boxes_[at(first)], triangle_boxes_[at(second)])) return;
    const Triangle &a = mesh_.triangles[at(first)], &b = mesh_.triangles[at(second)];
    int shared = 0;
    for (const int v : a) shared += static_cast<int>(std::count(b.begin(), b.end(), v));
    if (shared < 2 && (find_passing_side(a, b) >= 0 || find_passing_side(b, a) >= 0))
      pairs.push_back({first, second});
  }

  /// The side of a triangle that passes through the inside of another one, or -1.
  int find_passing_side(const Triangle& sides, const Triangle& triangle) const {
    const Vec3 &a = position(triangle[0]), &b = position(triangle[1]), &c = position(triangle[2]);
    for (Size i = 0; i < 3; ++i) {
      const Vec3 &p = position(sides[i]), &q = position(sides[(i + 1) % 3]);
      if (orientation(a, b, c, p) * orientation(a, b, c, q) != -1) continue;
      const int turn = orientation(p, q, a, b);
      if (turn != 0 && orientation(p, q, b, c) == turn && orientation(p, q, c, a) == turn)
        return static_cast<int>(i);
    }
    return -1;
  }

  Vec3 place_of(int first, int second) const {
    Triangle sides = mesh_.triangles[at(first)], triangle = mesh_.triangles[at(second)];
    int i = find_passing_side(sides, triangle);
    if (i < 0) {
      std::swap(sides, triangle);
      i = find_passing_side(sides, triangle);
    }
    const Vec3 &p = position(sides[at(i)]), &q = position(sides[(at(i) + 1) % 3]);
    const Vec3 &a = position(triangle[0]), &b = position(triangle[1]), &c = position(triangle[2]);
    const double height = oriented_volume(a, b, c, p);
    return p + height / (height - oriented_volume(a, b, c, q)) * (q - p);
  }

  const TriangleMesh& mesh_;
  TriangleTree tree_;
  std::vector<Box> boxes_, triangle_boxes_;
};

}  // namespace

SelfCrossings find_self_crossings(const TriangleMesh& mesh) {
  return SelfCrossingSearch(mesh).run();
}

}  // namespace shatterbox::geometry
