#include "engine/geometry/crossings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "engine/core/parallel.h"
#include "engine/geometry/bvh.h"

namespace shatterbox::geometry {
namespace {

using Size = std::size_t;

/// Sign of the volume of (a, b, c, d): 0 where rounding could have turned it.
int volume_sign(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 ad = a - d, bd = b - d, cd = c - d;
  const double volume = ad.dot(bd.cross(cd));
  const Vec3 size = bd.cwiseAbs();
  const Vec3 other = cd.cwiseAbs();
  const Vec3 products(size.y() * other.z() + size.z() * other.y(),
                      size.z() * other.x() + size.x() * other.z(),
                      size.x() * other.y() + size.y() * other.x());
  const double bound = 16.0 * std::numeric_limits<double>::epsilon() * ad.cwiseAbs().dot(products);
  return volume > bound ? 1 : volume < -bound ? -1 : 0;
}

using Corners = std::array<Vec3, 3>;

Corners corners_of(const TriangleMesh& mesh, int triangle) {
  const Triangle& t = mesh.triangles[static_cast<Size>(triangle)];
  return {mesh.positions[static_cast<Size>(t[0])], mesh.positions[static_cast<Size>(t[1])],
          mesh.positions[static_cast<Size>(t[2])]};
}

bool an_edge_pierces(const Corners& edges, const Corners& triangle) {
  for (Size i = 0; i < 3; ++i)
    if (segment_pierces_triangle(edges[i], edges[(i + 1) % 3], triangle[0], triangle[1], triangle[2]))
      return true;
  return false;
}

struct Tree {
  TriangleTree tree;
  std::vector<Box> boxes;
};

Tree make_tree(const TriangleMesh& mesh) {
  Tree tree{build_triangle_tree(mesh.positions, mesh.triangles), {}};
  tree.boxes = node_boxes(tree.tree, mesh);
  return tree;
}

long count_between(const TriangleMesh& a, const Tree& tree_a, const TriangleMesh& b, const Tree& tree_b) {
  long count = 0;
  std::vector<std::pair<int, int>> stack;
  for_each_leaf_pair(tree_a.tree, tree_a.boxes, tree_b.tree, tree_b.boxes, 0.0, stack,
                     [&](const TriangleTree::Node& leaf_a, const TriangleTree::Node& leaf_b) {
                       for (int i = leaf_a.begin; i < leaf_a.begin + leaf_a.count; ++i)
                         for (int j = leaf_b.begin; j < leaf_b.begin + leaf_b.count; ++j) {
                           const Corners p = corners_of(a, tree_a.tree.order[static_cast<Size>(i)]);
                           const Corners q = corners_of(b, tree_b.tree.order[static_cast<Size>(j)]);
                           if (an_edge_pierces(p, q) || an_edge_pierces(q, p)) ++count;
                         }
                     });
  return count;
}

}  // namespace

Piercing pierce(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
  const int side_p = volume_sign(a, b, c, p);
  const int side_q = volume_sign(a, b, c, q);
  if (side_p * side_q == 1) return Piercing::no;
  const int ab = volume_sign(p, q, a, b), bc = volume_sign(p, q, b, c), ca = volume_sign(p, q, c, a);
  if (std::min({ab, bc, ca}) == -1 && std::max({ab, bc, ca}) == 1) return Piercing::no;
  return side_p * side_q * ab * bc * ca == 0 ? Piercing::perhaps : Piercing::yes;
}

bool segment_pierces_triangle(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
  return pierce(p, q, a, b, c) == Piercing::yes;
}

long count_crossing_pairs(const std::vector<TriangleMesh>& meshes) {
  std::vector<Tree> trees(meshes.size());
  std::vector<long> counts(meshes.size(), 0);
  core::parallel_for(meshes.size(), 4, [&](Size i) { trees[i] = make_tree(meshes[i]); });
  core::parallel_for(meshes.size(), 1, [&](Size i) {
    for (Size j = i + 1; j < meshes.size(); ++j)
      counts[i] += count_between(meshes[i], trees[i], meshes[j], trees[j]);
  });
  return std::accumulate(counts.begin(), counts.end(), 0L);
}

}  // namespace shatterbox::geometry
