#include "engine/audit/triangle_crossing.h"

#include <algorithm>
#include <utility>

#include "engine/audit/exact_sign.h"
#include "engine/core/index.h"

namespace shatterbox::audit {
namespace {

using Signs = std::array<int, 3>;
using core::at;

Signs sides_of(const Corners& plane, const Corners& points) {
  Signs signs;
  for (std::size_t i = 0; i < 3; ++i) signs[i] = volume_sign(plane[0], plane[1], plane[2], points[i]);
  return signs;
}

bool is_on_both_sides(const Signs& s) {
  return std::max({s[0], s[1], s[2]}) > 0 && std::min({s[0], s[1], s[2]}) < 0;
}

/// Turns the triangle so that its first corner is alone on its side of the plane; the others are on the other
/// side or in it. Their signs are on both sides.
void put_lone_corner_first(Corners& triangle, Signs& signs) {
  const auto is_lone = [&](std::size_t i) {
    const int a = signs[(i + 1) % 3] * signs[i], b = signs[(i + 2) % 3] * signs[i];
    return signs[i] != 0 && a <= 0 && b <= 0;
  };
  std::size_t first = 0;
  while (!is_lone(first)) ++first;
  std::rotate(triangle.begin(), triangle.begin() + static_cast<std::ptrdiff_t>(first), triangle.end());
  std::rotate(signs.begin(), signs.begin() + static_cast<std::ptrdiff_t>(first), signs.end());
}

/// Drops the coordinate along which the triangle is seen with an area; false if it has none.
bool find_view(const Corners& triangle, int& u, int& v) {
  const Vec3 normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]).cwiseAbs();
  int best = 0;
  normal.maxCoeff(&best);
  for (int k = 0; k < 3; ++k) {
    u = (best + k + 1) % 3;
    v = (best + k + 2) % 3;
    const auto flat = [&](std::size_t i) { return Vec2(triangle[i][u], triangle[i][v]); };
    if (area_sign(flat(0), flat(1), flat(2)) != 0) return true;
  }
  return false;
}

template <std::size_t N>
std::array<Vec2, N> flatten(const std::array<Vec3, N>& points, int u, int v) {
  std::array<Vec2, N> flat;
  for (std::size_t i = 0; i < N; ++i) flat[i] = Vec2(points[i][u], points[i][v]);
  return flat;
}

/// True if one edge's line of `triangle` has all `points` on its outer side or on itself.
template <std::size_t N>
bool an_edge_separates(const std::array<Vec2, 3>& triangle, const std::array<Vec2, N>& points) {
  const int turn = area_sign(triangle[0], triangle[1], triangle[2]);
  for (std::size_t i = 0; i < 3; ++i) {
    const bool is_outside = std::all_of(points.begin(), points.end(), [&](const Vec2& p) {
      return area_sign(triangle[i], triangle[(i + 1) % 3], p) * turn <= 0;
    });
    if (is_outside) return true;
  }
  return false;
}

bool overlap_in_plane(const Corners& p, const Corners& q) {
  int u = 0, v = 0, other_u = 0, other_v = 0;
  if (!find_view(p, u, v) || !find_view(q, other_u, other_v)) return false;
  const auto flat_p = flatten(p, u, v), flat_q = flatten(q, u, v);
  return !an_edge_separates(flat_p, flat_q) && !an_edge_separates(flat_q, flat_p);
}

}  // namespace

bool triangles_cross(const Corners& p, const Corners& q) {
  Corners first = p, second = q;
  Signs second_sides = sides_of(first, second);
  if (second_sides == Signs{0, 0, 0}) return overlap_in_plane(p, q);
  if (!is_on_both_sides(second_sides)) return false;
  Signs first_sides = sides_of(second, first);
  if (!is_on_both_sides(first_sides)) return false;
  put_lone_corner_first(first, first_sides);
  put_lone_corner_first(second, second_sides);
  // Both cut the line that their planes share. Seen along it, an end of one's part (on an edge from its lone
  // corner) is ordered against an end of the other's by the volume of the two edges [GD03].
  if (first_sides[0] < 0) std::swap(second[1], second[2]);
  if (second_sides[0] < 0) std::swap(first[1], first[2]);
  return volume_sign(first[0], first[1], second[0], second[1]) < 0 &&
         volume_sign(first[0], first[2], second[2], second[0]) < 0;
}

int corner_off_hinge(const Corners& p, const Corners& q) {
  const Signs sides = sides_of(p, q);
  if (std::count(sides.begin(), sides.end(), 0) != 2) return -1;
  const int corner = sides[0] != 0 ? 0 : sides[1] != 0 ? 1 : 2;
  int u = 0, v = 0;
  if (!find_view(p, u, v)) return -1;
  const auto triangle = flatten(p, u, v);
  const auto edge = flatten(std::array<Vec3, 2>{q[at((corner + 1) % 3)], q[at((corner + 2) % 3)]}, u, v);
  if (edge[0] == edge[1] || an_edge_separates(triangle, edge)) return -1;
  int least = 1, greatest = -1;
  for (const Vec2& c : triangle) {
    const int side = area_sign(edge[0], edge[1], c);
    least = std::min(least, side);
    greatest = std::max(greatest, side);
  }
  return least < 0 && greatest > 0 ? corner : -1;
}

bool are_on_both_sides(const Corners& triangle, const Vec3& x, const Vec3& y) {
  return volume_sign(triangle[0], triangle[1], triangle[2], x) *
             volume_sign(triangle[0], triangle[1], triangle[2], y) <
         0;
}

}  // namespace shatterbox::audit
