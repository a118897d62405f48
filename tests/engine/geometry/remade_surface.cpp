#include "engine/geometry/remade_surface.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <utility>

#include "engine/core/elementary.h"
#include "engine/core/index.h"
#include "engine/core/random.h"
#include "engine/geometry/edge_topology.h"
#include "engine/geometry/mass_properties.h"
#include "engine/geometry/self_crossings.h"
#include "engine/geometry/surface_distance.h"
#include "engine/geometry/tetrahedralise.h"
#include "engine/geometry/winding_number.h"
#include "tests/engine/geometry/closed_surfaces.h"

using namespace shatterbox;
using namespace shatterbox::geometry;

namespace {

using core::at;

TriangleMesh pushed(TriangleMesh mesh, const Vec3& way) {
  for (Vec3& p : mesh.positions) p += way;
  return mesh;
}

/// Without the triangles that lie wholly above a height.
TriangleMesh cut_off(TriangleMesh mesh, double height) {
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return std::all_of(t.begin(), t.end(), [&](int v) { return mesh.positions[at(v)].y() > height; });
  });
  return mesh;
}

/// A ball that a vertex of it is pushed through, to the other side.
TriangleMesh pierced_ball() {
  TriangleMesh ball = make_sphere(0.1, fine(0.03)).value();
  ball.positions[7] *= -1.1;
  return ball;
}

const TriangleMesh& expect_clean(const core::Result<RemadeSurface>& made) {
  INFO((made ? "" : made.error()));
  REQUIRE(made);
  const TriangleMesh& mesh = made.value().mesh;
  const EdgeTopology edges = build_edge_topology(mesh.triangles);
  int wrong = 0;
  for (std::size_t e = 0; e < edges.edges.size(); ++e)
    wrong += edges.triangle_count(static_cast<int>(e)) == 2 ? 0 : 1;
  CHECK(wrong == 0);
  CHECK(find_self_crossings(mesh).count == 0);
  return mesh;
}

}  // namespace

TEST_CASE("winding numbers: 1 in a closed surface, 0 without, 2 in two, and no matter how coarse") {
  TriangleMesh both = make_sphere(0.1, fine(0.01)).value();
  append(both, pushed(both, Vec3(0.1, 0, 0)));
  const WindingNumber winding(both);
  CHECK(winding.about(Vec3(-0.05, 0, 0)) == Approx(1.0).margin(3e-3));
  CHECK(winding.about(Vec3(0.05, 0, 0)) == Approx(2.0).margin(6e-3));
  CHECK(winding.about(Vec3(0.05, 0.12, 0)) == Approx(0.0).margin(3e-3));
  CHECK(winding.about(Vec3(0, 0, 30)) == Approx(0.0).margin(1e-6));
}

TEST_CASE("winding numbers: a disc is seen under its solid angle") {
  TriangleMesh disc;
  constexpr int kCorners = 720;
  disc.positions.emplace_back(0, 0, 0);
  for (int i = 0; i < kCorners; ++i) {
    const double a = 2.0 * core::kPi * i / kCorners;
    disc.positions.emplace_back(core::cos(a), core::sin(a), 0.0);
    disc.triangles.push_back({0, i + 1, (i + 1) % kCorners + 1});
  }
  const WindingNumber winding(disc);
  for (const double height : {0.01, 0.3, 1.0, 4.0, 40.0}) {
    const double share = 0.5 * (1.0 - height / std::sqrt(1.0 + height * height));
    CHECK(winding.about(Vec3(0, 0, -height)) == Approx(share).margin(2e-3));
    CHECK(winding.about(Vec3(0, 0, height)) == Approx(-share).margin(2e-3));
  }
}

TEST_CASE("a remade ball is closed and lies on the ball") {
  const TriangleMesh ball = make_sphere(0.1, fine(0.01)).value();
  const auto made = remake_surface(ball, 0.008);
  const TriangleMesh& mesh = expect_clean(made);
  CHECK(made.value().bridged_share == 0.0);
  CHECK(made.value().lost_share == 0.0);
  CHECK(enclosed_volume(mesh) == Approx(enclosed_volume(ball)).epsilon(0.01));
  const SurfaceDistance given(ball);
  double farthest = 0.0;
  for (const Vec3& p : mesh.positions) farthest = std::max(farthest, given.find(p, 1.0).distance);
  CHECK(farthest <= 0.05 * 0.008 * 1.74);  // a vertex keeps away from the ends of its edge
  TriangleMesh inside_out = ball;
  for (Triangle& t : inside_out.triangles) std::swap(t[1], t[2]);
  CHECK(enclosed_volume(expect_clean(remake_surface(inside_out, 0.008))) == Approx(enclosed_volume(mesh)));
}

TEST_CASE("balls that overlap are remade as one, hollows stay") {
  constexpr double kRadius = 0.1, kApart = 0.12;
  TriangleMesh both = make_sphere(kRadius, fine(0.008)).value();
  append(both, pushed(both, Vec3(kApart, 0, 0)));
  const double lens =
      core::kPi / 12.0 * (4.0 * kRadius + kApart) * (2.0 * kRadius - kApart) * (2.0 * kRadius - kApart);
  const double ball = 4.0 / 3.0 * core::kPi * kRadius * kRadius * kRadius;
  CHECK(enclosed_volume(expect_clean(remake_surface(both, 0.006))) ==
        Approx(2.0 * ball - lens).epsilon(0.015));
  const TriangleMesh hollow = make_hollow_ball();
  CHECK(enclosed_volume(expect_clean(remake_surface(hollow, 0.006))) ==
        Approx(enclosed_volume(hollow)).epsilon(0.02));
}

TEST_CASE("a surface that passes through itself is remade so that tetrahedra can be made of it") {
  const TriangleMesh pierced = pierced_ball();
  REQUIRE(find_self_crossings(pierced).count > 0);
  REQUIRE_FALSE(tetrahedralise(pierced, {.element_size = 0.02}));
  const auto made = remake_surface(pierced, 0.01);
  const auto solid = tetrahedralise(expect_clean(made), {.element_size = 0.02});
  REQUIRE(solid);
  CHECK(solid.value().elements->mesh.tetrahedra.size() > 100);
}

TEST_CASE("small holes are closed, wide ones are not made up") {
  const TriangleMesh ball = make_sphere(0.1, fine(0.008)).value();
  const auto closed = remake_surface(cut_off(ball, 0.095), 0.006);
  CHECK(enclosed_volume(expect_clean(closed)) == Approx(enclosed_volume(ball)).epsilon(0.015));
  CHECK(closed.value().bridged_share > 0.005);
  CHECK(closed.value().bridged_share < 0.04);
  for (const double height : {0.06, 0.0, -0.05}) {
    const auto refused = remake_surface(cut_off(ball, height), 0.006);
    REQUIRE_FALSE(refused);
    INFO(refused.error());
    CHECK((refused.error().find("over holes") != std::string::npos ||
           refused.error().find("encloses nothing") != std::string::npos));
  }
}

TEST_CASE("what would be lost is told: loose sheets, and walls thinner than the grid") {
  TriangleMesh with_sheet = make_sphere(0.1, fine(0.02)).value();
  append(with_sheet,
         TriangleMesh{{{0.2, 0, 0}, {0.4, 0, 0}, {0.4, 0.2, 0}, {0.2, 0.2, 0}}, {{0, 1, 2}, {0, 2, 3}}});
  const auto sheet = remake_surface(with_sheet, 0.01);
  REQUIRE_FALSE(sheet);
  CHECK(sheet.error().find("encloses nothing") != std::string::npos);
  const auto thin = remake_surface(make_box_surface(Vec3(0.3, 0.2, 1e-4)), 0.01);
  REQUIRE_FALSE(thin);
  const auto rod = remake_surface(make_box_surface(Vec3(0.4, 0.013, 0.013)), 0.01);
  REQUIRE_FALSE(rod);
  CHECK(rod.error().find("smaller elements") != std::string::npos);
  const auto fine_rod = remake_surface(make_box_surface(Vec3(0.4, 0.013, 0.013)), 0.002);
  CHECK(enclosed_volume(expect_clean(fine_rod)) == Approx(8.0 * 0.4 * 0.013 * 0.013).epsilon(0.05));
  CHECK_FALSE(remake_surface(make_box_surface(Vec3(1, 1, 1)), 1e-3));  // a thousand million nodes
  CHECK_FALSE(remake_surface(TriangleMesh{}, 0.01));
}
