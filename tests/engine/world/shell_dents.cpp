// Dents of sheets: a pot that is hit keeps the shape of the hit, whatever the step, and meets nobody on its
// way, itself neither.
#include <catch2/catch.hpp>

#include <cmath>

#include "engine/core/parallel.h"
#include "engine/geometry/generators.h"
#include "engine/geometry/mass_properties.h"
#include "tests/engine/world/audited.h"
#include "tests/support/sanitized.h"

using namespace shatterbox;

namespace {

struct PotHit {
  double speed = 8.0;  // m/s, of a steel ball of 3 cm radius, against the pot's wall from the side
  int rate = 240;
  double gap = 0.0;  // m, behind the wall to a block in the pot that does not move; 0: none
  const char* material = "steel";
};

struct PotRun {
  world::World world;
  audit::AuditReport audit;
  double area = 0.0;  // m2, of the pot before
};

PotRun hit_pot(const PotHit& hit, double seconds = 0.1) {
  world::WorldSettings settings;
  settings.steps_per_second = hit.rate;
  settings.gravity = Vec3::Zero();
  PotRun run{world::World(settings), {}};
  world::World& w = run.world;
  const auto metal = w.add_material(*material::find_preset(hit.material));
  REQUIRE(metal.ok());
  world::ShellDescription shell;
  shell.mesh =
      geometry::make_bowl({0.12, 0.05, 0.006, 0.1}, {test::kIsSanitized ? 0.03 : 0.012, 0.3, 1}).value();
  shell.thickness = 1e-3;
  run.area = geometry::surface_area(shell.mesh);
  world::BodyDescription pot, ball;
  pot.name = "pot";
  pot.form = shell;
  REQUIRE(w.add_body(pot).ok());
  ball.form = world::SphereDescription{0.03};
  ball.pose.translation = Vec3(0.17 + 0.003 * hit.speed, 0.06, 0.0);
  ball.velocity = Vec3(-hit.speed, 0.0, 0.0);
  REQUIRE(w.add_body(ball).ok());
  if (hit.gap > 0.0) {
    world::BodyDescription block;
    block.form = world::BoxDescription{Vec3(0.02, 0.02, 0.02)};
    block.pose.translation = Vec3(0.105 - 0.02 - hit.gap, 0.065, 0.0);
    block.motion = body::Motion::fixed;
    REQUIRE(w.add_body(block).ok());
  }
  run.audit = test::run_audited(w, seconds);
  return run;
}

}  // namespace

TEST_CASE("shell dents: the deeper the harder, the same at any rate, and none where nothing yields") {
  double last = 0.0;
  for (const double speed : {3.0, 6.0, 12.0}) {
    const PotRun run = hit_pot({speed});
    CAPTURE(speed);
    REQUIRE_FALSE(run.world.report().dents.empty());
    const world::DentRow& dent = run.world.report().dents[0];
    CHECK(dent.von_mises > dent.yield);
    CHECK(dent.share == 1.0);
    CHECK(dent.depth > 1.3 * last);
    CHECK(dent.mass_error < 1e-12);
    CHECK(std::abs(dent.volume_change) < 0.005);
    CHECK(dent.energy < 0.5 * 0.89 * speed * speed);
    CHECK(run.world.report().breaks.empty());
    CHECK(run.world.report().conservation.momentum_error < 1e-9);
    CHECK(run.audit.crossings + run.audit.passages == 0);
    CHECK(run.audit.exempt_pairs == 0);
    last = dent.depth;
    if (test::kIsSanitized) return;
  }
  for (const int rate : {480, 960}) {
    const PotRun run = hit_pot({12.0, rate});
    REQUIRE_FALSE(run.world.report().dents.empty());
    CHECK(run.world.report().dents[0].depth == Approx(last).epsilon(0.01));
  }
  const PotRun tap = hit_pot({0.05});
  CHECK(tap.world.report().dents.empty());
}

TEST_CASE("shell dents: the pot keeps its mass, has another shape, and goes on with its momentum") {
  const PotRun run = hit_pot({8.0});
  for (const body::Body& body : run.world.bodies()) {
    if (body.shape->kind != body::ShapeKind::shell) continue;
    CHECK(body.shape->mass == Approx(run.area * 1e-3 * 7850.0).epsilon(1e-9));
    CHECK(geometry::surface_area(body.shape->surface) == Approx(run.area).epsilon(0.005));
    CHECK(body.velocity.x() < 0.0);
    double dented = 0.0;
    for (const Vec3& p : body.shape->surface.positions)
      dented = std::max(dented, Vec2(p.x() + body.shape->material_from_body.x(), p.z()).norm() - 0.12);
    CHECK(dented > 1e-3);  // its rim is no circle any more
    CHECK(body.name == "pot");
  }
}

TEST_CASE("shell dents: a dent goes as far as there is room behind it") {
  if (test::kIsSanitized) return;
  const PotRun run = hit_pot({12.0, 240, 0.004});
  REQUIRE_FALSE(run.world.report().dents.empty());
  CHECK(run.world.report().dents[0].share < 1.0);
  CHECK(run.audit.crossings + run.audit.passages == 0);
  CHECK(run.world.report().contact.crossing_pairs == 0);
}

TEST_CASE("shell dents: the same bits for any number of threads") {
  if (test::kIsSanitized) return;
  const auto hash = [](int threads) {
    core::set_thread_count(threads);
    const std::uint64_t bits = hit_pot({8.0}, 0.06).world.state_hash();
    core::set_thread_count(0);
    return bits;
  };
  CHECK(hash(1) == hash(3));
}

namespace {

struct SheetShots {
  std::vector<double> speeds;  // m/s, of balls of 3 cm radius and 0.89 kg, one after the other
  double apart = 0.0;          // m, between the places that they hit
  double gap = 0.0;            // m, behind the sheet to a wall that stands; 0: none
};

/// At a sheet of steel in its frame, 1.5 mm thick.
PotRun shoot_sheet(const SheetShots& shots, int rate) {
  world::WorldSettings settings;
  settings.steps_per_second = rate;
  settings.gravity = Vec3::Zero();
  PotRun run{world::World(settings), {}};
  world::World& w = run.world;
  REQUIRE(w.add_material(*material::find_preset("steel")).ok());
  world::ShellDescription shell;
  shell.mesh = geometry::make_pane(0.5, 0.5, {test::kIsSanitized ? 0.05 : 0.02, 0.3, 1}).value();
  shell.thickness = 1.5e-3;
  for (std::size_t v = 0; v < shell.mesh.positions.size(); ++v)
    if (shell.mesh.positions[v].cwiseAbs().maxCoeff() > 0.25 - 1e-9)
      shell.clamped.push_back(static_cast<int>(v));
  run.area = geometry::surface_area(shell.mesh);
  world::BodyDescription sheet, ball;
  sheet.name = "sheet";
  sheet.form = shell;
  REQUIRE(w.add_body(sheet).ok());
  ball.name = "ball";
  ball.form = world::SphereDescription{0.03};
  double until = 0.0;
  for (std::size_t i = 0; i < shots.speeds.size(); ++i) {
    const double place = 0.013 + shots.apart * static_cast<double>(i);
    // The next one arrives 20 ms after.
    until = i == 0 ? 0.3 / shots.speeds[0] : until + 0.02;
    ball.pose.translation = Vec3(place, -0.021, shots.speeds[i] * until);
    ball.velocity = Vec3(0.0, 0.0, -shots.speeds[i]);
    REQUIRE(w.add_body(ball).ok());
  }
  if (shots.gap > 0.0) {
    world::BodyDescription wall;
    wall.form = world::BoxDescription{Vec3(0.2, 0.2, 0.02)};
    wall.pose.translation = Vec3(0.0, 0.0, -0.02 - shots.gap);
    wall.motion = body::Motion::fixed;
    REQUIRE(w.add_body(wall).ok());
  }
  run.audit =
      test::run_audited(w, until + std::max(0.9 / shots.speeds.back(), shots.speeds.size() > 1 ? 0.05 : 0.0));
  return run;
}

}  // namespace

TEST_CASE(
    "shell dents: who brings enough goes through a sheet, as fast as the law says, and leaves it dished") {
  double last = 0.0;
  for (const int rate : {240, 960}) {
    const PotRun run = shoot_sheet({{80.0}}, rate);
    const world::WorldReport& report = run.world.report();
    CAPTURE(rate);
    REQUIRE(report.breaks.size() == 1);
    CHECK(report.breaks[0].pieces == 2);
    CHECK(report.breaks[0].mass_error < 1e-10);
    CHECK(report.breaks[0].momentum_error < 1e-10);
    CHECK(run.audit.crossings + run.audit.passages == 0);
    double speed = 0.0, mass = 0.0, plug = 0.0;
    for (const body::Body& body : run.world.bodies()) {
      if (body.name == "ball") {
        speed = -body.velocity.z();
        mass = body.shape->mass;
      }
      if (body.name == "sheet/1") plug = body.shape->mass;
    }
    // m / (m + m_plug) sqrt(v^2 - v_limit^2) [RI63].
    const double needed = report.breaks[0].fracture_energy;
    CHECK(plug > 0.03);
    CHECK(speed ==
          Approx(mass / (mass + plug) * std::sqrt(80.0 * 80.0 - 2.0 * needed / mass)).epsilon(0.002));
    REQUIRE(report.dents.size() == 1);
    CHECK(report.dents[0].depth > 1e-3);
    if (last > 0.0) CHECK(report.dents[0].depth == Approx(last).epsilon(0.02));
    last = report.dents[0].depth;
    if (test::kIsSanitized) return;
  }
  const PotRun held = shoot_sheet({{40.0}}, 240);
  CHECK(held.world.report().breaks.empty());
  REQUIRE(held.world.report().impacts.size() >= 1);
  CHECK(held.world.report().impacts[0].perforation_ratio < 1.0);
  CHECK(held.world.report().impacts[0].perforation_ratio > 0.3);
}

TEST_CASE("shell dents: hits after a hole, one soon after the other, have each a dent of its own") {
  if (test::kIsSanitized) return;
  const PotRun run = shoot_sheet({{80.0, 30.0, 30.0, 30.0}, -0.08}, 480);
  REQUIRE(run.world.report().breaks.size() == 1);
  REQUIRE(run.world.report().dents.size() == 4);
  for (const world::DentRow& dent : run.world.report().dents) CHECK(dent.depth > 2e-3);
  CHECK(run.audit.crossings + run.audit.passages == 0);
}

TEST_CASE("shell dents: a held sheet keeps out of a wall that stands behind it") {
  if (test::kIsSanitized) return;
  const PotRun run = shoot_sheet({{40.0}, 0.0, 0.004}, 240);
  REQUIRE(run.world.report().dents.size() >= 1);
  for (const world::DentRow& dent : run.world.report().dents) {
    CHECK(dent.share < 1.0);
    CHECK(dent.depth < 0.01);
  }
  for (const body::Body& body : run.world.bodies()) {
    if (body.name != "sheet") continue;
    for (const Vec3& p : body.shape->surface.positions)
      if (const Vec3 x = body.pose.apply(p); x.head<2>().cwiseAbs().maxCoeff() < 0.19) CHECK(x.z() > -0.004);
  }
}

TEST_CASE("shell dents: a steel pot thrown on a floor crumples, the harder the more, and does not shatter") {
  double last = 0.0;
  for (const double speed : {10.0, 20.0, 60.0}) {
    world::WorldSettings settings;
    settings.gravity = Vec3::Zero();
    world::World w(settings);
    REQUIRE(w.add_material(*material::find_preset("steel")).ok());
    world::ShellDescription shell;
    shell.mesh =
        geometry::make_bowl({0.12, 0.05, 0.006, 0.1}, {test::kIsSanitized ? 0.03 : 0.012, 0.3, 1}).value();
    shell.thickness = 1e-3;
    world::BodyDescription floor, pot;
    floor.form = world::PlaneDescription{};
    REQUIRE(w.add_body(floor).ok());
    pot.form = shell;
    pot.pose.translation = Vec3(0.0, 0.25, 0.0);
    pot.pose.rotation = Quat(Eigen::AngleAxisd(1.9, Vec3::UnitZ()));
    pot.velocity = Vec3(0.0, -speed, 0.0);
    REQUIRE(w.add_body(pot).ok());
    const audit::AuditReport audit = test::run_audited(w, 0.2 / speed + 0.05);
    CAPTURE(speed);
    CHECK(w.report().breaks.empty());
    REQUIRE(w.report().dents.size() >= 1);
    const world::DentRow& dent = w.report().dents[0];
    CHECK(dent.depth > 1.05 * last);
    last = dent.depth;
    CHECK(dent.mass_error < 1e-12);
    CHECK(std::abs(dent.volume_change) < 0.01);
    CHECK(audit.crossings + audit.passages == 0);
    if (test::kIsSanitized) return;
  }
}
