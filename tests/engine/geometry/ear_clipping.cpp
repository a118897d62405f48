// Convex polygons as triangles.
#include "engine/geometry/ear_clipping.h"

#include <catch2/catch.hpp>

using namespace shatterbox;
using namespace shatterbox::geometry;

namespace {

double area_of(const std::vector<Vec2>& polygon, const Triangle& t) {
  const Vec2 a = polygon[static_cast<std::size_t>(t[1])] - polygon[static_cast<std::size_t>(t[0])];
  const Vec2 b = polygon[static_cast<std::size_t>(t[2])] - polygon[static_cast<std::size_t>(t[0])];
  return 0.5 * (a.x() * b.y() - a.y() * b.x());
}

}  // namespace

TEST_CASE(
    "ears of a convex polygon: two fewer than corners, all counter-clockwise, together the polygon's area") {
  const std::vector<std::vector<Vec2>> polygons{
      {{0, 0}, {1, 0}, {0, 1}},
      {{0, 0}, {3, 0}, {3, 1}, {2, 2}, {0, 2}},          // 5.5 m2
      {{0, 0}, {1, 0}, {2, 0}, {2, 2}, {1, 2}, {0, 2}},  // corners on straight sides: 4 m2
  };
  const double areas[] = {0.5, 5.5, 4.0};
  for (std::size_t p = 0; p < polygons.size(); ++p) {
    const std::vector<Triangle> triangles = clip_ears(polygons[p]);
    CHECK(triangles.size() == polygons[p].size() - 2);
    double sum = 0.0;
    for (const Triangle& t : triangles) {
      CHECK(area_of(polygons[p], t) > 0.0);
      sum += area_of(polygons[p], t);
    }
    CHECK(sum == Approx(areas[p]).epsilon(1e-14));
  }
}

TEST_CASE("a polygon without area has no ears") {
  CHECK(clip_ears({{0, 0}, {1, 0}, {2, 0}}).empty());
  CHECK(clip_ears({}).empty());
}
