#include "engine/geometry/level_set.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "engine/core/elementary.h"
#include "engine/core/index.h"
#include "engine/core/parallel.h"
#include "engine/core/random.h"
#include "engine/geometry/generators.h"
#include "engine/geometry/surface_distance.h"
#include "tests/engine/geometry/closed_surfaces.h"
#include "tests/support/sanitized.h"

using namespace shatterbox;
using namespace shatterbox::geometry;
using core::at;

namespace {

struct Gridded {
  const char* name;
  TriangleMesh surface;
};

TriangleMesh turned(TriangleMesh mesh) {
  const Quat turn = Quat(0.8, 0.2, -0.5, 0.3).normalized();
  for (Vec3& p : mesh.positions) p = turn * p + Vec3(0.013, -0.4, 0.07);
  return mesh;
}

std::vector<Gridded> gridded_shapes() {
  TriangleMesh two = make_box_surface(Vec3(0.1, 0.1, 0.1));
  append(two, turned(make_box_surface(Vec3(0.05, 0.02, 0.03))));
  return {{"sphere", make_sphere(0.1, fine(0.02)).value()},
          {"box on the grid's planes", make_box_surface(Vec3(0.096, 0.048, 0.024))},
          {"turned box", turned(make_box_surface(Vec3(0.1, 0.07, 0.05)))},
          {"torus", make_torus(0.1, 0.03, fine(0.02)).value()},
          {"thin plate", turned(make_box_surface(Vec3(0.1, 0.1, 0.0005)))},
          {"star", make_star()},
          {"hollow", make_hollow_ball()},
          {"two boxes", two}};
}

/// How often the surface goes round p: solid angles of its triangles [VOS83].
double winding_number(const TriangleMesh& surface, const Vec3& p) {
  double sum = 0.0;
  for (const Triangle& t : surface.triangles) {
    const Vec3 a = surface.positions[at(t[0])] - p, b = surface.positions[at(t[1])] - p,
               c = surface.positions[at(t[2])] - p;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    sum += 2.0 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return sum / (4.0 * core::kPi);
}

Vec3 node_place(const LevelSet& set, int i, int j, int k) {
  return set.spacing() * Vec3(set.low()[0] + i, set.low()[1] + j, set.low()[2] + k);
}

}  // namespace

TEST_CASE("level set: nodes near a surface have its distance and all nodes its side") {
  const int step = test::kIsSanitized ? 9 : 4;
  for (const Gridded& shape : gridded_shapes()) {
    INFO(shape.name);
    const LevelSetSpace space = make_level_set_space(0.2);
    const auto made = LevelSet::make(shape.surface, Vec3::Zero(), space);
    REQUIRE(made.ok());
    const LevelSet& set = *made.value();
    const SurfaceDistance exact(shape.surface);
    const auto [nx, ny, nz] = set.count();
    double worst_near = 0.0, worst_far = 0.0;
    long wrong_sides = 0, looked_at = 0;
    for (int k = 0; k < nz; k += step)
      for (int j = 0; j < ny; j += step)
        for (int i = 0; i < nx; i += step) {
          const Vec3 p = node_place(set, i, j, k);
          const double value = static_cast<double>(set.values()[at(i + nx * (j + ny * k))]);
          const double distance = exact.find(p, 1e3).distance;
          ++looked_at;
          if (distance < TrianglePatch::kReach * set.spacing())
            worst_near = std::max(worst_near, std::abs(std::abs(value) - distance) / set.spacing());
          else
            worst_far = std::max(worst_far, std::abs(std::abs(value) - distance) / set.spacing());
          if (distance > 1e-9 * set.spacing()) {
            const bool is_inside = std::abs(winding_number(shape.surface, p)) > 0.5;
            wrong_sides += is_inside != (value < 0.0) ? 1 : 0;
          }
        }
    CHECK(looked_at > test::how_many(300, 30));
    CHECK(worst_near < 3e-6);  // cells: corners are snapped to a millionth of one
    CHECK(worst_far < 0.2);
    CHECK(wrong_sides == 0);
  }
}

TEST_CASE("level set: between nodes it is linear and slopes outwards by one") {
  const TriangleMesh ball = make_sphere(0.1, fine(0.01)).value();
  const LevelSetSpace space = make_level_set_space(0.2);
  const auto set = LevelSet::make(ball, Vec3::Zero(), space).value();
  const SurfaceDistance exact(ball);
  core::Random random(5, 1);
  for (int k = 0; k < 2000; ++k) {
    const Vec3 way =
        Vec3(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)).normalized();
    const double radius = random.uniform(0.05, 0.115);
    const double distance = exact.find(radius * way, 1.0).distance;
    CHECK(std::abs(std::abs(set->distance(radius * way)) - distance) < 0.05 * set->spacing());
    CHECK(set->gradient(radius * way).dot(way) == Approx(1.0).margin(0.06));
  }
  // Beyond the grid it goes on growing.
  CHECK(set->distance(Vec3(0.0, 0.3, 0.0)) == Approx(0.2).margin(set->spacing()));
}

TEST_CASE("level set: kept work of triangles gives the same bits as work done anew") {
  TriangleMesh whole = make_torus(0.1, 0.03, fine(0.01)).value();
  const LevelSetSpace space = make_level_set_space(0.26);
  const auto first = LevelSet::make(whole, Vec3::Zero(), space).value();
  const PatchCache::Figures alone = space.patches->figures();
  CHECK(alone.found == 0);
  CHECK(alone.made == static_cast<long>(whole.triangles.size()));
  CHECK(alone.bytes > 100.0 * static_cast<double>(alone.made));

  // A piece: as many triangles as before, a few of them new, its own centre, corners counted from others.
  const Vec3 shift(0.012, -0.003, 0.0071);
  TriangleMesh piece = whole;
  for (Vec3& p : piece.positions) p -= shift;
  for (std::size_t v = 0; v < 20; ++v) piece.positions[v] *= 0.97;
  for (Triangle& t : piece.triangles) std::rotate(t.begin(), t.begin() + 1, t.end());
  std::reverse(piece.triangles.begin(), piece.triangles.end());
  const auto from_cache = LevelSet::make(piece, shift, space).value();
  const PatchCache::Figures then = space.patches->figures();
  CHECK(then.made - alone.made < 200);
  CHECK(then.found > alone.made - 200);

  LevelSetSpace fresh = space;
  fresh.patches = std::make_shared<PatchCache>();
  core::set_thread_count(1);
  const auto anew = LevelSet::make(piece, shift, fresh).value();
  core::set_thread_count(0);
  CHECK(from_cache->low() == anew->low());
  CHECK(from_cache->values() == anew->values());
  CHECK(fresh.patches->figures().found == 0);
}

TEST_CASE("level set: what is dented has the distances of its new surface, with what is kept of the old") {
  const TriangleMesh ball = make_sphere(0.1, fine(0.01)).value();
  const LevelSetSpace space = make_level_set_space(0.2);
  REQUIRE(LevelSet::make(ball, Vec3::Zero(), space).ok());
  TriangleMesh dented = ball;
  for (Vec3& p : dented.positions)  // pressed in at the top, by 4 cm at most
    if (const double over = p.y() - 0.06; over > 0.0) p.y() -= 1.0 * over;
  const auto set = LevelSet::make(dented, Vec3::Zero(), space).value();
  CHECK(space.patches->figures().found > static_cast<long>(ball.triangles.size() / 2));
  const SurfaceDistance exact(dented);
  for (const Vec3& p : {Vec3(0.0, 0.09, 0.0), Vec3(0.01, 0.065, 0.01), Vec3(0.0, 0.05, 0.0),
                        Vec3(0.02, 0.055, -0.01), Vec3(0.0, -0.095, 0.0), Vec3(0.09, 0.0, 0.0)}) {
    const double distance = exact.find(p, 1e3).distance;
    const double sign = std::abs(winding_number(dented, p)) > 0.5 ? -1.0 : 1.0;
    CHECK(set->distance(p) == Approx(sign * distance).margin(0.3 * set->spacing()));
  }
  CHECK(set->distance(Vec3(0.0, 0.09, 0.0)) > 0.02);  // it was inside of the ball
}

TEST_CASE("level set: a piece that is too small for the grid has none") {
  const LevelSetSpace space = make_level_set_space(0.2);
  CHECK(space.spacing == Approx(0.2 / kLevelSetCells));
  const auto tiny = LevelSet::make(make_box_surface(Vec3(0.01, 0.01, 0.01)), Vec3::Zero(), space);
  REQUIRE(!tiny.ok());
  CHECK(tiny.error().find("too coarse") != std::string::npos);
  const auto huge = LevelSet::make(make_box_surface(Vec3(10.0, 0.1, 0.1)), Vec3::Zero(), space);
  REQUIRE(!huge.ok());
  CHECK(huge.error().find("too fine") != std::string::npos);
  CHECK(!LevelSet::make({}, Vec3::Zero(), space).ok());
}
