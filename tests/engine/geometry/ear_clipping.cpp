// Polygons as triangles.
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

TEST_CASE("ears of a polygon: two fewer than corners, all counter-clockwise, together the polygon's area") {
  const std::vector<std::vector<Vec2>> polygons{
      {{0, 0}, {1, 0}, {0, 1}},
      {{0, 0}, {3, 0}, {3, 1}, {2, 2}, {0, 2}},          // 5.5 m2
      {{0, 0}, {1, 0}, {2, 0}, {2, 2}, {1, 2}, {0, 2}},  // corners on straight sides: 4 m2
      {{0, 0}, {4, 0}, {4, 4}, {2, 0.1}, {0, 4}},        // a notch nearly to the other side: 8.2 m2
      {{0, 0}, {4, 0}, {4, 3}, {3, 3}, {3, 1}, {1, 1}, {1, 3}, {0, 3}},  // two: 8 m2
  };
  const double areas[] = {0.5, 5.5, 4.0, 8.2, 8.0};
  for (std::size_t p = 0; p < polygons.size(); ++p) {
    const std::vector<Triangle> triangles = clip_ears(polygons[p]);
    CHECK(triangles.size() == polygons[p].size() - 2);
    double sum = 0.0;
    for (const Triangle& t : triangles) {
      CHECK(area_of(polygons[p], t) > 0.0);
      sum += area_of(polygons[p], t);
    }
    CHECK(sum == Approx(areas[p]).epsilon(1e-14));
    // None reaches over a notch: no corner lies inside of one.
    for (const Triangle& t : triangles)
      for (std::size_t k = 0; k < polygons[p].size(); ++k) {
        std::vector<Vec2> with = polygons[p];
        with.push_back(polygons[p][k]);
        const int own = static_cast<int>(with.size()) - 1;
        CHECK_FALSE((area_of(with, {t[0], t[1], own}) > 1e-12 && area_of(with, {t[1], t[2], own}) > 1e-12 &&
                     area_of(with, {t[2], t[0], own}) > 1e-12));
      }
  }
}

TEST_CASE("a polygon without area has no ears") {
  CHECK(clip_ears({{0, 0}, {1, 0}, {2, 0}}).empty());
  CHECK(clip_ears({}).empty());
}
