// Rings become triangles that close them, whatever their shape.
#include "engine/geometry/ring_triangles.h"

#include <catch2/catch.hpp>
#include <map>

#include "engine/core/random.h"

using namespace shatterbox;
using namespace shatterbox::geometry;

namespace {

/// Each side of the ring once, each diagonal once in each direction.
bool closes(const std::vector<Triangle>& triangles, int n) {
  std::map<std::pair<int, int>, int> count;
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) ++count[{t[k], t[(k + 1) % 3]}];
  for (const auto& [side, times] : count) {
    if (times != 1) return false;
    const bool is_side = side.second == (side.first + 1) % n;
    if (!is_side && !count.count({side.second, side.first})) return false;
  }
  for (int i = 0; i < n; ++i)
    if (!count.count({i, (i + 1) % n})) return false;
  return triangles.size() == static_cast<std::size_t>(n - 2);
}

double area_of(const std::vector<Vec2>& ring, const std::vector<Triangle>& triangles, double& least) {
  double sum = 0.0;
  least = 1e300;
  for (const Triangle& t : triangles) {
    std::vector<Vec2> corners;
    for (const int i : t) corners.push_back(ring[static_cast<std::size_t>(i)]);
    const double area = twice_area(corners) / 2.0;
    least = std::min(least, area);
    sum += area;
  }
  return sum;
}

}  // namespace

TEST_CASE("ring triangles: a comb") {
  std::vector<Vec2> ring{{0, 0}, {10, 0}};
  for (int i = 10; i >= 1; --i) {
    ring.emplace_back(i, 5);
    ring.emplace_back(i - 0.5, 1);
  }
  ring.emplace_back(0, 5);
  const auto triangles = triangulate_ring(ring);
  double least = 0.0;
  CHECK(closes(triangles, static_cast<int>(ring.size())));
  CHECK(area_of(ring, triangles, least) == Approx(twice_area(ring) / 2.0));
  CHECK(least > 0.0);
}

TEST_CASE("ring triangles: corners on straight sides get triangles with area") {
  const std::vector<Vec2> ring{{0, 0}, {1, 0}, {2, 0}, {3, 0}, {3, 1}, {3, 2}, {0, 2}, {0, 1}};
  const auto triangles = triangulate_ring(ring);
  double least = 0.0;
  CHECK(closes(triangles, 8));
  CHECK(area_of(ring, triangles, least) == Approx(6.0));
  CHECK(least > 0.1);
}

TEST_CASE("ring triangles: the best ear is not clipped if it leaves a line") {
  const std::vector<Vec2> ring{{0, 0}, {1, 0}, {2, 0}, {1, 1.7}};
  double least = 0.0;
  CHECK(area_of(ring, triangulate_ring(ring), least) == Approx(1.7));
  CHECK(least > 0.8);
}

TEST_CASE("ring triangles: a square with two holes") {
  const std::vector<std::vector<Vec2>> loops{{{0, 0}, {4, 0}, {4, 4}, {0, 4}},
                                             {{1, 1}, {1, 2}, {2, 2}, {2, 1}},
                                             {{2.5, 2.5}, {2.5, 3.5}, {3.5, 3.5}}};
  const auto order = join_holes(loops);
  REQUIRE(order.size() == 4 + 4 + 3 + 4);
  std::vector<Vec2> ring;
  for (const auto& [loop, place] : order)
    ring.push_back(loops[static_cast<std::size_t>(loop)][static_cast<std::size_t>(place)]);
  const auto triangles = triangulate_ring(ring);
  double least = 0.0;
  CHECK(closes(triangles, 15));
  CHECK(area_of(ring, triangles, least) == Approx(16.0 - 1.0 - 0.5));
  CHECK(least > 0.0);
  CHECK(is_inside(loops[0], {0.5, 0.5}));
  CHECK_FALSE(is_inside(loops[2], {2.6, 2.6 - 0.2}));
}

TEST_CASE("ring triangles: rings without area, or that cross themselves, are closed all the same") {
  core::Random random(3);
  for (int trial = 0; trial < 300; ++trial) {
    std::vector<Vec2> ring;
    const int n = 3 + static_cast<int>(random.index(9));
    for (int i = 0; i < n; ++i) {
      const double x = trial % 3 == 0 ? 0.0 : random.uniform();
      ring.emplace_back(x, trial % 3 == 1 ? 0.0 : random.uniform());
    }
    CHECK(closes(triangulate_ring(ring), n));
  }
  CHECK(closes(triangulate_ring(std::vector<Vec2>(6, Vec2(1, 1))), 6));
}
