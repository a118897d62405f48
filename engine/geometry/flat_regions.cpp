#include "engine/geometry/flat_regions.h"

#include <array>
#include <utility>

#include "engine/core/index.h"
#include "engine/geometry/ring_triangles.h"

namespace shatterbox::geometry {
namespace {

using Size = std::size_t;
using core::at;
using Places = std::vector<Vec2>;

double turn_between(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Never turns right, and turns round once.
bool is_convex(const Places& loop) {
  constexpr double kStraight = 1e-12;
  const Size n = loop.size();
  int turns = 0;  // of the sides' direction from down to up
  for (Size i = 0; i < n; ++i) {
    const Vec2 before = loop[i] - loop[(i + n - 1) % n];
    const Vec2 after = loop[(i + 1) % n] - loop[i];
    const double least = kStraight * before.norm() * after.norm();
    if (!(turn_between(before, after) >= -least)) return false;
    if (before.dot(after) < 0.0 && !(turn_between(before, after) > least)) return false;
    const auto is_up = [](const Vec2& d) { return d.y() > 0.0 || (d.y() == 0.0 && d.x() > 0.0); };
    if (!is_up(before) && is_up(after)) ++turns;
  }
  return turns == 1;
}

/// An outer border and the holes in it.
struct Region {
  std::vector<const std::vector<int>*> vertices;
  std::vector<Places> places;
};

/// Holes belong to the smallest loop about them; one that is in none was turned over by rounding.
std::vector<Region> find_regions(const std::vector<std::vector<int>>& loops, std::vector<Places> places) {
  std::vector<Region> regions;
  std::vector<Size> holes;
  for (Size i = 0; i < loops.size(); ++i) {
    if (loops.size() > 1 && twice_area(places[i]) < 0.0)
      holes.push_back(i);
    else
      regions.push_back({{&loops[i]}, {std::move(places[i])}});
  }
  const Size outer_count = regions.size();
  for (const Size i : holes) {
    Size owner = outer_count;
    for (Size r = 0; r < outer_count; ++r)
      if (is_inside(regions[r].places[0], places[i][0]) &&
          (owner == outer_count || twice_area(regions[r].places[0]) < twice_area(regions[owner].places[0])))
        owner = r;
    if (owner == outer_count) {
      regions.emplace_back();
      owner = regions.size() - 1;
    }
    regions[owner].vertices.push_back(&loops[i]);
    regions[owner].places.push_back(std::move(places[i]));
  }
  return regions;
}

}  // namespace

std::vector<std::vector<int>> divide_flat_region(const std::vector<Vec3>& positions,
                                                 const std::vector<std::vector<int>>& loops,
                                                 const Vec3& normal) {
  const Vec3 e1 = normal.normalized().unitOrthogonal(), e2 = normal.normalized().cross(e1);
  const Vec3& origin = positions[at(loops[0][0])];
  std::vector<Places> places(loops.size());
  for (Size i = 0; i < loops.size(); ++i)
    for (const int v : loops[i]) {
      const Vec3 d = positions[at(v)] - origin;
      places[i].emplace_back(d.dot(e1), d.dot(e2));
    }
  std::vector<std::vector<int>> polygons;
  for (const Region& region : find_regions(loops, std::move(places))) {
    if (region.places.size() == 1 && is_convex(region.places[0])) {
      polygons.push_back(*region.vertices[0]);
      continue;
    }
    std::vector<int> ring;
    Places ring_places;
    for (const auto& [loop, place] : join_holes(region.places)) {
      ring.push_back((*region.vertices[at(loop)])[at(place)]);
      ring_places.push_back(region.places[at(loop)][at(place)]);
    }
    for (const Triangle& t : triangulate_ring(ring_places)) {
      const int a = ring[at(t[0])], b = ring[at(t[1])], c = ring[at(t[2])];
      // A line to and fro is no polygon: its two sides are each other's opposites.
      if (a != b && b != c && c != a) polygons.push_back({a, b, c});
    }
  }
  return polygons;
}

}  // namespace shatterbox::geometry
