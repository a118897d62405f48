#include "engine/geometry/common_inside.h"

#include <catch2/catch.hpp>

#include "engine/geometry/generators.h"

namespace shatterbox::geometry {
namespace {

TriangleMesh block(const Vec3& half, const Vec3& middle) {
  TriangleMesh mesh = make_box_surface(half);
  for (Vec3& p : mesh.positions) p += middle;
  return mesh;
}

bool meet(const TriangleMesh& a, const TriangleMesh& b, double least = 1e-9) {
  CHECK(have_common_inside(a, b, least) == have_common_inside(b, a, least));
  return have_common_inside(a, b, least);
}

}  // namespace

TEST_CASE("common inside: of blocks with their sides in one plane too, as deep as is asked") {
  const Vec3 half(0.1, 0.05, 0.1);
  const TriangleMesh first = block(half, Vec3(0.3, 2.0, 0.1));
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      const auto beside = [&](double overlap) {
        Vec3 middle(0.3, 2.0, 0.1);
        middle[axis] += side * (2.0 * half[axis] - overlap);
        return block(half, middle);
      };
      CHECK(meet(first, beside(0.003)));
      CHECK(meet(first, beside(1e-6)));
      CHECK_FALSE(meet(first, beside(1e-6), 1e-5));
      CHECK_FALSE(meet(first, beside(0.0)));
      CHECK_FALSE(meet(first, beside(-0.001)));
    }
  CHECK(meet(first, block(0.3 * half, Vec3(0.3, 2.0, 0.1))));
  CHECK(meet(first, block(half, Vec3(0.33, 2.02, 0.15))));
}

TEST_CASE("common inside: of a ball of thousands of triangles in a block, or on it") {
  TriangleMesh ball = make_sphere(0.05, {0.003, 0.3, 1}).value();
  REQUIRE(ball.triangles.size() > 2000);
  const TriangleMesh floor = block(Vec3(0.2, 0.05, 0.2), Vec3(0, -0.05, 0));
  double lowest = 0.0;
  for (const Vec3& p : ball.positions) lowest = std::min(lowest, p.y());
  for (Vec3& p : ball.positions) p.y() -= lowest;
  CHECK_FALSE(meet(ball, floor));
  for (Vec3& p : ball.positions) p.y() -= 0.01;
  CHECK(meet(ball, floor));
}

}  // namespace shatterbox::geometry
