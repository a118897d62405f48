#include "engine/geometry/crossings.h"

#include <catch2/catch.hpp>

#include "engine/core/random.h"

using namespace shatterbox;
using geometry::TriangleMesh;

namespace {

TriangleMesh triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
  return {{a, b, c}, {{0, 1, 2}}};
}

}  // namespace

TEST_CASE("a segment through a triangle, beside it, and only touching it") {
  const Vec3 a(0, 0, 0), b(1, 0, 0), c(0, 1, 0);
  CHECK(geometry::segment_pierces_triangle(Vec3(0.2, 0.2, -1), Vec3(0.3, 0.3, 1), a, b, c));
  CHECK_FALSE(geometry::segment_pierces_triangle(Vec3(0.9, 0.9, -1), Vec3(0.9, 0.9, 1), a, b, c));
  CHECK_FALSE(geometry::segment_pierces_triangle(Vec3(0.2, 0.2, 0), Vec3(0.3, 0.3, 1), a, b, c));
  CHECK_FALSE(geometry::segment_pierces_triangle(Vec3(0.5, 0.0, -1), Vec3(0.5, 0.0, 1), a, b, c));
  CHECK_FALSE(geometry::segment_pierces_triangle(Vec3(0.2, 0.2, 0.1), Vec3(0.3, 0.3, 1), a, b, c));
}

TEST_CASE("planted crossings are counted, neighbours that touch are not") {
  const TriangleMesh flat = triangle(Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0));
  const TriangleMesh upright = triangle(Vec3(0.2, 0.2, -1), Vec3(0.4, 0.2, 1), Vec3(0.2, 0.4, 1));
  const TriangleMesh beside = triangle(Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(1, 1, 0));
  CHECK(geometry::count_crossing_pairs({flat, upright}) == 1);
  CHECK(geometry::count_crossing_pairs({flat, beside}) == 0);
  CHECK(geometry::count_crossing_pairs({flat, upright, beside}) == 1);
}

TEST_CASE("the count is the brute-force count of crossing pairs") {
  core::Random random(5);
  const auto point = [&] {
    const double x = random.uniform(), y = random.uniform(), z = random.uniform();
    return Vec3(x, y, z);
  };
  std::vector<TriangleMesh> soups(4);
  for (TriangleMesh& soup : soups)
    for (int t = 0; t < 40; ++t) {
      const Vec3 centre = point();
      for (int k = 0; k < 3; ++k) soup.positions.push_back(centre + 0.3 * point());
      soup.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
    }
  long expected = 0;
  for (std::size_t i = 0; i < soups.size(); ++i)
    for (std::size_t j = i + 1; j < soups.size(); ++j)
      for (int s = 0; s < 40; ++s)
        for (int t = 0; t < 40; ++t) {
          const Vec3* p = &soups[i].positions[static_cast<std::size_t>(3 * s)];
          const Vec3* q = &soups[j].positions[static_cast<std::size_t>(3 * t)];
          bool crosses = false;
          for (int k = 0; k < 3; ++k) {
            crosses |= geometry::segment_pierces_triangle(p[k], p[(k + 1) % 3], q[0], q[1], q[2]);
            crosses |= geometry::segment_pierces_triangle(q[k], q[(k + 1) % 3], p[0], p[1], p[2]);
          }
          expected += crosses;
        }
  REQUIRE(expected > 20);
  CHECK(geometry::count_crossing_pairs(soups) == expected);
}
