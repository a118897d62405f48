// Shifts of touching surfaces: through, or to the side on which they are.
#include "engine/dynamics/shift_test.h"

#include <catch2/catch.hpp>

#include "engine/collision/collider.h"
#include "tests/engine/dynamics/bodies.h"

using namespace shatterbox;

namespace {

/// Whether `surface` goes through `other` by that shift.
bool is_through(const geometry::TriangleMesh& surface, const geometry::TriangleMesh& other,
                const Vec3& shift) {
  const body::Body a = test::make_shell(surface), b = test::make_shell(other);
  const auto collider = collision::make_collider(*a.shape), standing = collision::make_collider(*b.shape);
  Pose there = a.pose;
  there.translation += shift;
  return dynamics::goes_through(collision::place_collider(*collider, a.pose),
                                collision::place_collider(*collider, there),
                                collision::place_collider(*standing, b.pose), shift.norm());
}

}  // namespace

TEST_CASE("a vertex goes through a triangle to its other side, and not away from it or beside it") {
  const geometry::TriangleMesh floor{{{-1, 0, -1}, {1, 0, -1}, {0, 0, 1}}, {{0, 1, 2}}};
  for (const double gap : {1e-9, 1e-16}) {
    const geometry::TriangleMesh tip{{{0, gap, 0}, {0.3, 1, 0}, {0, 1, 0.3}}, {{0, 1, 2}}};
    CHECK(is_through(tip, floor, Vec3(0, -1e-6, 0)));
    CHECK_FALSE(is_through(tip, floor, Vec3(0, 1e-6, 0)));
    CHECK_FALSE(is_through(tip, floor, Vec3(1e-6, 0, 0)));
    CHECK(is_through(floor, tip, Vec3(0, 1e-6, 0)));  // the same, the other one shifted
    CHECK_FALSE(is_through(floor, tip, Vec3(0, -1e-6, 0)));
  }
  const geometry::TriangleMesh beside{{{2, 1e-9, 0}, {2.3, 1, 0}, {2, 1, 0.3}}, {{0, 1, 2}}};
  CHECK_FALSE(is_through(beside, floor, Vec3(0, -1e-6, 0)));
}

TEST_CASE("an edge goes through an edge") {
  const geometry::TriangleMesh below{{{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}}, {{0, 1, 2}}};
  const geometry::TriangleMesh above{{{0.1, 1e-12, -1}, {0.1, 1e-12, 1}, {0.1, 1, 0}}, {{0, 1, 2}}};
  CHECK(is_through(above, below, Vec3(0, -1e-6, 0)));
  CHECK_FALSE(is_through(above, below, Vec3(0, 1e-6, 0)));
  CHECK_FALSE(is_through(above, below, Vec3(1e-6, 0, 0)));
}
