// How far a surface can change its shape before it meets itself.
#include "engine/world/dent_room.h"

#include <catch2/catch.hpp>

using namespace shatterbox;
using namespace shatterbox::world;

namespace {

/// Two squares of a metre, one 10 cm above the other; the upper one's vertices go by `move`.
MovingSurface two_sheets(const Vec3& move) {
  MovingSurface surface;
  for (const double y : {0.0, 0.1})
    for (const Vec2& p : {Vec2(0, 0), Vec2(1, 0), Vec2(1, 1), Vec2(0, 1)})
      surface.start.push_back(Vec3(p.x(), y, p.y()));
  surface.end = surface.start;
  for (std::size_t v = 4; v < 8; ++v) surface.end[v] += move;
  surface.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
  return surface;
}

}  // namespace

TEST_CASE("dent room: a sheet goes as far as it does not meet itself") {
  CHECK(own_free_share(two_sheets(Vec3(0, 1, 0)), 1e-4) == 1.0);
  CHECK(own_free_share(two_sheets(Vec3(0, -0.05, 0)), 1e-4) == 1.0);
  const double share = own_free_share(two_sheets(Vec3(0, -0.4, 0)), 1e-4);
  CHECK(share <= 0.25 - 2e-4);
  CHECK(share > 0.24);
  // Past each other: on the way they would meet, at its end they would not.
  CHECK(own_free_share(two_sheets(Vec3(0.2, -0.4, 0.1)), 1e-4) < 0.26);
}

TEST_CASE(
    "dent room: a triangle that turns about an edge that it shares does not meet its neighbour for that") {
  MovingSurface fold;
  fold.start = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0.5, 0, 1), Vec3(0.5, 0, -1)};
  fold.end = fold.start;
  fold.end[3] = Vec3(0.5, 1, 0);
  fold.triangles = {{0, 1, 2}, {1, 0, 3}};
  CHECK(own_free_share(fold, 1e-4) == 1.0);
  fold.end[3] = Vec3(0.5, 0, 0.9);  // flat onto it
  CHECK(own_free_share(fold, 1e-4) < 1.0);
}
