#include "engine/geometry/closest_points.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "engine/core/random.h"

namespace shatterbox::geometry {
namespace {

Vec3 draw(core::Random& random) {
  const double x = random.uniform(-1, 1);
  const double y = random.uniform(-1, 1);
  const double z = random.uniform(-1, 1);
  return {x, y, z};
}

}  // namespace

TEST_CASE("the closest point of a triangle is closer than all others") {
  core::Random random(1);
  for (int n = 0; n < 300; ++n) {
    const Vec3 p = 2.0 * draw(random), a = draw(random), b = draw(random), c = draw(random);
    const auto found = closest_on_triangle(p, a, b, c);
    CHECK(found.barycentric.minCoeff() >= 0.0);
    CHECK(found.barycentric.sum() == Approx(1.0));
    const Vec3& w = found.barycentric;
    CHECK((w[0] * a + w[1] * b + w[2] * c - found.closest).norm() < 1e-14);
    for (int i = 0; i <= 10; ++i) {
      for (int j = 0; j <= 10 - i; ++j) {
        const Vec3 q = a + 0.1 * i * (b - a) + 0.1 * j * (c - a);
        CHECK(found.distance <= (p - q).norm() + 1e-14);
      }
    }
  }
}

TEST_CASE("degenerate triangles are segments and points") {
  const Vec3 a(0, 0, 0), b(2, 0, 0);
  CHECK(closest_on_triangle(Vec3(1, 1, 0), a, b, 0.5 * (a + b)).distance == Approx(1.0));
  CHECK(closest_on_triangle(Vec3(0, 3, 4), a, a, a).distance == Approx(5.0));
}

TEST_CASE("closest points of segments, crossing, parallel and degenerate") {
  const auto crossing =
      closest_between_segments(Vec3(-1, 0, 0), Vec3(1, 0, 0), Vec3(0, 0.25, -1), Vec3(0, 0.25, 3));
  CHECK(crossing.distance == Approx(0.25));
  CHECK(crossing.s == Approx(0.5));
  CHECK(crossing.t == Approx(0.25));
  CHECK(closest_between_segments(Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0.5, 1, 0), Vec3(3, 1, 0)).distance ==
        Approx(1.0));
  CHECK(closest_between_segments(Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(4, 4, 0), Vec3(7, 4, 0)).distance ==
        Approx(5.0));
  CHECK(closest_between_segments(Vec3(0, 0, 0), Vec3(0, 0, 0), Vec3(3, 4, 0), Vec3(3, 4, 0)).distance ==
        Approx(5.0));
  core::Random random(2);
  for (int n = 0; n < 300; ++n) {
    const Vec3 p0 = draw(random), p1 = draw(random), q0 = draw(random), q1 = draw(random);
    const double found = closest_between_segments(p0, p1, q0, q1).distance;
    for (int i = 0; i <= 10; ++i) {
      for (int j = 0; j <= 10; ++j) {
        CHECK(found <= (p0 + 0.1 * i * (p1 - p0) - q0 - 0.1 * j * (q1 - q0)).norm() + 1e-14);
      }
    }
  }
}

TEST_CASE("the surface of a box has a sign") {
  const Vec3 half(1, 2, 3);
  const auto outside = closest_on_box(Vec3(4, 6, 0), half);
  CHECK(outside.signed_distance == Approx(5.0));
  CHECK((outside.normal - Vec3(0.6, 0.8, 0)).norm() < 1e-15);
  const auto inside = closest_on_box(Vec3(0, -1.75, 0), half);
  CHECK(inside.signed_distance == Approx(-0.25));
  CHECK(inside.normal == Vec3(0, -1, 0));
}

}  // namespace shatterbox::geometry
