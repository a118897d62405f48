// Dents: what yields keeps the shape that a hit leaves it in, whatever the step, and meets nobody on its way.
#include <catch2/catch.hpp>

#include <cmath>

#include "engine/core/parallel.h"
#include "engine/geometry/generators.h"
#include "engine/geometry/mass_properties.h"
#include "engine/geometry/self_crossings.h"
#include "tests/engine/world/audited.h"
#include "tests/support/sanitized.h"

using namespace shatterbox;

namespace {

struct SlabHit {
  double speed = 100.0;  // m/s, of a steel ball of 3 cm radius
  int rate = 240;
  bool is_held = false;  // by its foot
  double gap = 0.0;      // m, behind the slab's middle to a crate; 0: no crate
  bool has_copy = false;
  double plasticity = 1.0;
  bool goes_through = true;  // false: without going back nobody perforates, and what is overloaded cracks
  Vec3 half_extent = Vec3(0.2, 0.15, 0.01);                // m, of the slab
  double element_size = test::kIsSanitized ? 0.04 : 0.02;  // m
};

struct SlabRun {
  world::World world;
  audit::AuditReport audit;
};

/// m, greatest: from the middle of a crack face to the nearest one that looks the other way.
double torn_gap(const body::Shape& shape) {
  std::vector<std::pair<Vec3, Vec3>> faces;  // middle, unit normal
  for (std::size_t t = 0; t < shape.surface.triangles.size(); ++t) {
    if (shape.crack_faces.empty() || shape.crack_faces[t] == 0) continue;
    const auto& corners = shape.surface.triangles[t];
    const auto p = [&](std::size_t k) {
      return shape.surface.positions[static_cast<std::size_t>(corners[k])];
    };
    const Vec3 area = (p(1) - p(0)).cross(p(2) - p(0));
    if (area.norm() > 1e-9) faces.emplace_back((p(0) + p(1) + p(2)) / 3.0, area.normalized());
  }
  double widest = 0.0;
  for (const auto& [middle, normal] : faces) {
    double nearest = 1e300;
    for (const auto& [other, facing] : faces)
      if (normal.dot(facing) < -0.5) nearest = std::min(nearest, (other - middle).norm());
    if (nearest < 1e300) widest = std::max(widest, nearest);
  }
  return widest;
}

/// A ball hits the middle of a steel slab.
SlabRun hit_slab(const SlabHit& hit, double seconds = 0.03) {
  world::WorldSettings settings;
  settings.steps_per_second = hit.rate;
  settings.gravity = Vec3::Zero();
  if (!hit.goes_through) settings.after_break = world::AfterBreak::inherit;
  SlabRun run{world::World(settings), {}};
  world::World& w = run.world;
  material::Material steel = *material::find_preset("steel");
  steel.plasticity = hit.plasticity;
  REQUIRE(w.add_material(steel).ok());
  world::BodyDescription slab;
  slab.name = "slab";
  world::SolidDescription solid;
  solid.mesh = geometry::make_box_surface(hit.half_extent);
  solid.element_size = hit.element_size;
  if (hit.is_held) solid.held = {{Vec3::UnitY(), 0.02 - hit.half_extent.y()}};
  slab.form = solid;
  REQUIRE(w.add_body(slab).ok());
  if (hit.has_copy) {
    slab.pose.translation = Vec3(1.0, 0.0, 0.0);
    REQUIRE(w.add_body(slab).ok());
  }
  world::BodyDescription ball;
  ball.form = world::SphereDescription{0.03};
  ball.pose.translation = Vec3(0.0, 0.0, 0.05 + 0.003 * hit.speed);
  ball.velocity = Vec3(0.0, 0.0, -hit.speed);
  REQUIRE(w.add_body(ball).ok());
  if (hit.gap > 0.0) {
    world::BodyDescription crate;
    crate.form = world::BoxDescription{Vec3::Constant(0.05)};
    crate.pose.translation = Vec3(0.0, 0.0, -0.06 - hit.gap);
    REQUIRE(w.add_body(crate).ok());
  }
  run.audit = test::run_audited(w, seconds);
  return run;
}

}  // namespace

TEST_CASE("a hit beyond the yield strength leaves a dent, the deeper the harder and the same at any rate") {
  double last = 0.0;
  for (const double speed : {40.0, 80.0, 120.0}) {
    const SlabRun run = hit_slab({speed});
    REQUIRE(run.world.report().dents.size() == 1);
    const world::DentRow& dent = run.world.report().dents[0];
    CAPTURE(speed);
    CHECK(dent.von_mises > dent.yield);
    CHECK(dent.yield == material::find_preset("steel")->yield);
    CHECK(dent.share == 1.0);
    CHECK(dent.depth > 1.3 * last);
    last = dent.depth;
    CHECK(dent.mass_error < 1e-12);
    CHECK(std::abs(dent.volume_change) < 0.01);
    CHECK(dent.energy < 0.5 * 0.9 * speed * speed);
    CHECK(run.audit.crossings + run.audit.passages == 0);
    if (test::kIsSanitized) return;
  }
  for (const int rate : {60, 960}) {
    const SlabRun run = hit_slab({120.0, rate});
    REQUIRE(run.world.report().dents.size() == 1);
    CHECK(run.world.report().dents[0].depth == Approx(last).epsilon(0.03));
  }
  const SlabRun half = hit_slab({80.0, 240, false, 0.0, false, 0.5}), whole = hit_slab({80.0});
  CHECK(half.world.report().dents[0].depth ==
        Approx(0.5 * whole.world.report().dents[0].depth).epsilon(0.05));
}

TEST_CASE(
    "dents that turn what they bend do not swell it, in light and narrow plates and where there is no room") {
  if (test::kIsSanitized) return;  // its steps are those of the tests above
  const auto expect_volume = [](const SlabHit& hit, double depth) {
    const SlabRun run = hit_slab(hit);
    CAPTURE(hit.speed, hit.half_extent.x(), hit.gap);
    REQUIRE_FALSE(run.world.report().dents.empty());
    const world::DentRow& dent = run.world.report().dents[0];
    CHECK(dent.depth > depth);
    CHECK(std::abs(dent.volume_change) < 0.03);
    CHECK(dent.mass_error < 1e-12);
    CHECK((dent.share < 1.0) == (hit.gap > 0.0));
    CHECK(run.audit.crossings + run.audit.passages == 0);
    for (const body::Body& body : run.world.bodies())
      if (body.id == dent.born)
        CHECK(geometry::enclosed_volume(body.shape->surface) * 7850.0 ==
              Approx(body.shape->mass).epsilon(0.03));
  };
  SlabHit hit{350.0, 240, true};
  expect_volume(hit, 0.05);
  hit.half_extent = Vec3(0.06, 0.15, 0.01);
  hit.speed = 300.0;
  expect_volume(hit, 0.05);
  hit.is_held = false;
  hit.speed = 180.0;  // at 250 it is torn in two
  expect_volume(hit, 0.04);
  // Half of the way is not half of every move.
  hit.half_extent = Vec3(0.2, 0.15, 0.01);
  hit.speed = 350.0;
  hit.is_held = true;
  hit.gap = 0.03;
  expect_volume(hit, 0.01);
}

TEST_CASE("what is dented keeps its momentum and its centre, and its copies keep their shape") {
  const SlabRun run = hit_slab({100.0, 240, false, 0.0, true});
  const world::World& w = run.world;
  REQUIRE(w.report().dents.size() == 1);
  CHECK(w.report().conservation.momentum_error < 1e-9);
  int slabs = 0;
  for (const body::Body& body : w.bodies()) {
    if (body.shape->kind != body::ShapeKind::solid) continue;
    ++slabs;
    double thickest = 0.0;
    for (const Vec3& p : body.shape->surface.positions) thickest = std::max(thickest, std::abs(p.z()));
    const bool is_copy = body.pose.translation.x() > 0.9;
    if (is_copy) CHECK(thickest == Approx(0.01).epsilon(1e-3));
    if (!is_copy) CHECK(thickest > 0.012);
    if (!is_copy) CHECK(body.velocity.z() < 0.0);
    CHECK(geometry::enclosed_volume(body.shape->surface) > 0.0);
    CHECK(body.shape->mass == Approx(0.4 * 0.3 * 0.02 * 7850.0).epsilon(1e-9));
  }
  CHECK(slabs == 2);
}

TEST_CASE("what tears breaks into pieces of its mass and keeps no dent") {
  const SlabRun run = hit_slab({900.0, 240, true, 0.0, false, 1.0, false});
  const world::World& w = run.world;
  REQUIRE_FALSE(w.report().breaks.empty());
  CHECK(w.report().dents.empty());
  CHECK(w.report().breaks[0].mass_error < 1e-10);
  CHECK(w.report().breaks[0].momentum_error < 1e-10);
  CHECK(run.audit.crossings + run.audit.passages == 0);
}

TEST_CASE("metal that is strained beyond its elongation and not gone through tears, and its tears gape") {
  if (test::kIsSanitized) return;
  double depth = 0.0;
  for (const int rate : {240, 60, 960}) {
    const SlabRun run = hit_slab({365.0, rate, true});
    const world::World& w = run.world;
    CAPTURE(rate);
    CHECK(w.report().breaks.empty());
    REQUIRE(w.report().dents.size() == 1);
    const world::DentRow& dent = w.report().dents[0];
    CHECK(dent.torn_area > 1e-4);
    CHECK(dent.torn_area < 0.3 * 0.02 + 0.4 * 0.02);
    CHECK(dent.mass_error < 1e-12);
    CHECK(std::abs(dent.volume_change) < 0.03);
    CHECK(run.audit.crossings + run.audit.passages == 0);
    if (depth == 0.0) depth = dent.depth;
    CHECK(dent.depth == Approx(depth).epsilon(1e-6));
    bool has_torn = false;
    for (const world::ImpactRow& row : w.report().impacts)
      has_torn = has_torn || row.verdict.starts_with("torn, in one piece");
    CHECK(has_torn);
    for (const body::Body& body : w.bodies()) {
      if (body.shape->kind != body::ShapeKind::solid) continue;
      CHECK(body.id == dent.born);
      CHECK(geometry::enclosed_volume(body.shape->surface) * 7850.0 ==
            Approx(body.shape->mass).epsilon(0.03));
      CHECK(torn_gap(*body.shape) > 1e-3);
      CHECK(geometry::find_self_crossings(body.shape->surface).count == 0);
    }
  }
  CHECK(hit_slab({200.0, 240, true}).world.report().dents[0].torn_area == 0.0);
}

TEST_CASE("what is torn shows the stress that tore it") {
  SlabHit hit{365.0, 240, true};
  hit.element_size = 0.02;  // coarser ones do not tear
  const SlabRun run = hit_slab(hit);
  REQUIRE(run.world.report().dents.size() == 1);
  const world::DentRow& dent = run.world.report().dents[0];
  CHECK(dent.torn_area > 0.0);
  CHECK(run.audit.crossings + run.audit.passages == 0);
  const world::StressPicture picture = run.world.stress_picture(dent.born);
  const body::Body* slab = body::find_body(run.world.bodies(), dent.born);
  REQUIRE(slab);
  REQUIRE(picture.triangle_stress.size() == slab->shape->surface.triangles.size());
  double greatest = 0.0;
  for (const double stress : picture.triangle_stress) {
    CHECK(stress >= 0.0);
    greatest = std::max(greatest, stress);
  }
  CHECK(greatest > 0.0);
  CHECK(greatest <= 1.01 * run.world.report().impacts[0].stress);
}

TEST_CASE("tears leave a free plate energy for a dent, the same at any rate") {
  if (test::kIsSanitized) return;
  const auto hit = [](double speed, int rate) {
    SlabHit free{speed, rate};
    free.half_extent = Vec3(0.3, 0.25, 0.015);
    const SlabRun run = hit_slab(free);
    CAPTURE(speed, rate);
    CHECK(run.world.report().breaks.empty());
    CHECK(run.audit.crossings + run.audit.passages == 0);
    REQUIRE(run.world.report().dents.size() >= 1);
    CHECK(run.world.report().dents[0].torn_area > 1e-3);
    return run.world.report().dents[0].depth;
  };
  CHECK(hit(360.0, 240) > 0.04);
  const double depth = hit(450.0, 240);
  CHECK(depth > 0.04);
  CHECK(hit(450.0, 960) == Approx(depth).epsilon(0.1));
}

TEST_CASE("a torn slab is hit again, dented again and gone through, and stays one piece with its tear") {
  if (test::kIsSanitized) return;
  SlabRun run = hit_slab({365.0, 240, true});
  world::World& w = run.world;
  REQUIRE(w.report().dents.size() == 1);
  const auto shoot = [&](const Vec3& place, double speed) {
    world::BodyDescription ball;
    ball.form = world::SphereDescription{0.03};
    ball.pose.translation = place + Vec3(0.0, 0.0, 0.5);
    ball.velocity = Vec3(0.0, 0.0, -speed);
    REQUIRE(w.add_body(ball).ok());
    const audit::AuditReport audit = test::run_audited(w, w.time() + 0.03);
    CHECK(audit.crossings + audit.passages == 0);
  };
  shoot(Vec3(-0.1, 0.05, 0.0), 120.0);
  CHECK(w.report().dents.size() == 2);
  shoot(Vec3(0.12, -0.05, 0.0), 600.0);
  REQUIRE(w.report().breaks.size() == 1);
  CHECK(w.report().breaks[0].mass_error < 1e-10);
  CHECK(world::count_overlaps(w.report().breaks[0]) == 0);
}

TEST_CASE("a dent goes as far as there is room") {
  if (test::kIsSanitized) return;  // its steps are those of the tests above
  const SlabRun free = hit_slab({120.0, 240, true}), crowded = hit_slab({120.0, 240, true, 0.004});
  REQUIRE(free.world.report().dents.size() == 1);
  REQUIRE_FALSE(crowded.world.report().dents.empty());
  const world::DentRow &wide = free.world.report().dents[0], &narrow = crowded.world.report().dents[0];
  CHECK(wide.depth > 0.006);
  CHECK(narrow.share < 1.0);
  CHECK(narrow.depth < 0.006);
  CHECK(crowded.audit.crossings + crowded.audit.passages == 0);
  CHECK(crowded.world.report().contact.crossing_pairs == 0);
}

TEST_CASE("what lies does not creep, and what does not yield has no dents") {
  world::WorldSettings settings;
  settings.has_sleep = false;
  world::World w(settings);
  material::Material soft = *material::find_preset("steel");
  soft.yield = 1e3;  // Pa: its own weight is more
  REQUIRE(w.add_material(soft).ok());
  world::BodyDescription ground, slab;
  ground.form = world::PlaneDescription{};
  REQUIRE(w.add_body(ground).ok());
  world::SolidDescription solid;
  solid.mesh = geometry::make_box_surface(Vec3(0.2, 0.1, 0.1));
  solid.element_size = 0.1;
  slab.form = solid;
  slab.pose.translation = Vec3(0, 0.1001, 0);
  REQUIRE(w.add_body(slab).ok());
  for (int i = 0; i < 240; ++i) w.step();
  CHECK(w.report().dents.empty());
  CHECK(material::find_preset("plaster")->yield == 0.0);
}

TEST_CASE("a dent has the same bits for any number of threads") {
  if (test::kIsSanitized) return;
  const auto hash = [](int threads) {
    core::set_thread_count(threads);
    const std::uint64_t bits = hit_slab({100.0}).world.state_hash();
    core::set_thread_count(0);
    return bits;
  };
  CHECK(hash(1) == hash(3));
}
