// A step that is asked to stop leaves nothing behind it, wherever it was.
#include <atomic>
#include <catch2/catch.hpp>
#include <cmath>

#include "engine/core/parallel.h"
#include "engine/geometry/generators.h"
#include "engine/world/world.h"
#include "tests/support/sanitized.h"

using namespace shatterbox;

namespace {

/// Above a plane, just before they hit it: a glass sphere of 40 mm radius and a slab of plaster.
world::World make_falling() {
  world::World w{world::WorldSettings{}};
  material::Material glass = *material::find_preset("glass"), plaster = *material::find_preset("plaster");
  glass.flaw_area = 1e-3;
  const int glass_number = w.add_material(glass).value(), plaster_number = w.add_material(plaster).value();
  world::BodyDescription ground, ball, slab;
  ground.form = world::PlaneDescription{};
  REQUIRE(w.add_body(ground).ok());
  ball.name = "ball";
  ball.material = glass_number;
  ball.pose.translation = Vec3(0, 0.045, 0);
  ball.velocity = Vec3(0, -2.0, 0);
  world::ShellDescription shell;
  geometry::Meshing meshing;
  meshing.edge_length = test::kIsSanitized ? 0.012 : 0.008;
  shell.mesh = geometry::make_sphere(0.04, meshing).value();
  shell.thickness = 0.5e-3;
  ball.form = shell;
  REQUIRE(w.add_body(ball).ok());
  slab.name = "slab";
  slab.material = plaster_number;
  slab.pose.translation = Vec3(0.3, 0.07, 0);
  slab.pose.rotation = Quat(Eigen::AngleAxisd(0.3, Vec3(1, 2, 3).normalized()));
  slab.velocity = Vec3(0, -10.0, 0);
  world::SolidDescription solid;
  solid.mesh = geometry::make_box_surface(Vec3(0.08, 0.02, 0.05));
  solid.element_size = test::kIsSanitized ? 0.04 : 0.02;
  slab.form = solid;
  REQUIRE(w.add_body(slab).ok());
  return w;
}

constexpr int kSteps = 4;

/// What a world reports, as far as it must not depend on stops.
std::vector<double> figures_of(const world::World& w) {
  const world::WorldReport& report = w.report();
  std::vector<double> figures{
      static_cast<double>(report.impacts.size()), static_cast<double>(report.breaks.size()),
      static_cast<double>(report.triangles_most), static_cast<double>(report.tetrahedra_most),
      static_cast<double>(report.solver.solves),  report.conservation.momentum_error,
      report.conservation.greatest_energy_rise};
  for (const body::Body& body : w.bodies()) {
    figures.push_back(static_cast<double>(w.ancestry(body.id).parent));
    for (const double stress : w.stress_picture(body.id).triangle_stress) figures.push_back(stress);
  }
  return figures;
}

}  // namespace

TEST_CASE("a step that is stopped anywhere leaves the world as it was, and taken again gives the same bits") {
  core::set_thread_count(2);
  world::World plain = make_falling();
  for (int i = 0; i < kSteps; ++i) REQUIRE(plain.step());
  REQUIRE(plain.report().breaks.size() >= 2);

  world::World w = make_falling();
  std::atomic<long> asked = 0, most = -1;
  w.set_stop([&] { return most >= 0 && ++asked > most; });
  long stops = 0;
  for (int i = 0; i < kSteps; ++i) {
    // At its first question, and at ever later ones, until there are none left.
    for (most = 0;; most = (test::kIsSanitized ? 4000 : 20) * most + 7) {
      const std::uint64_t hash = w.state_hash();
      const std::vector<double> before = figures_of(w);
      const auto bodies = w.bodies().size();
      asked = 0;
      if (w.step()) break;
      ++stops;
      CHECK(w.state_hash() == hash);
      CHECK(w.bodies().size() == bodies);
      CHECK(w.report().steps == i);
      const std::vector<double> after = figures_of(w);
      CHECK(std::equal(before.begin(), before.begin() + 7, after.begin()));
    }
  }
  CHECK(stops > kSteps);
  CHECK(w.state_hash() == plain.state_hash());
  CHECK(figures_of(w) == figures_of(plain));
  core::set_thread_count(0);
}

TEST_CASE("a world that is asked to stop before a step takes none") {
  world::World w{world::WorldSettings{}};
  bool wants = true;
  w.set_stop([&wants] { return wants; });
  CHECK_FALSE(w.step());
  CHECK(w.steps() == 0);
  wants = false;
  CHECK(w.step());
  CHECK(w.steps() == 1);
}
