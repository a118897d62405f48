// Explosions against what their law and geometry say in closed form.
#include "engine/dynamics/blast.h"

#include <catch2/catch.hpp>

#include "engine/core/elementary.h"
#include "engine/geometry/generators.h"
#include "engine/world/world.h"

using namespace shatterbox;
using namespace shatterbox::dynamics;

namespace {

world::World make_world(int steps_per_second = 240) {
  world::WorldSettings settings;
  settings.gravity.setZero();
  settings.steps_per_second = steps_per_second;
  world::World w(settings);
  material::Material plain = *material::find_preset("steel");
  REQUIRE(w.add_material(plain).ok());
  REQUIRE(w.add_material(*material::find_preset("glass")).ok());
  return w;
}

body::BodyId add(world::World& w, decltype(world::BodyDescription::form) form, const Vec3& position) {
  world::BodyDescription description;
  description.form = std::move(form);
  description.pose.translation = position;
  return w.add_body(description).value();
}

world::ShellDescription pane(double side, double edge_length, bool is_breakable) {
  world::ShellDescription shell;
  shell.mesh = geometry::make_pane(side, side, {edge_length, 0.0, 1}).value();
  shell.thickness = 0.004;
  shell.is_breakable = is_breakable;
  return shell;
}

Vec3 impulse_on(const world::World& w, const Blast& blast, body::BodyId id) {
  const std::vector<body::Body> bodies(w.bodies().begin(), w.bodies().end());
  const LineOfSight sight(bodies);
  Vec3 sum = Vec3::Zero();
  for (const BlastPatch& patch : find_blast_patches(blast, *body::find_body(bodies, id), sight))
    sum += patch.impulse;
  return sum;
}

}  // namespace

TEST_CASE("a far small face takes twice the free impulse when met squarely, and less when it leans") {
  world::World w = make_world();
  const auto id = add(w, pane(0.02, 0.01, false), Vec3(0, 0, 10));  // in the plane z = 0
  const Blast blast{Vec3::Zero(), 1e5, 0.0};
  const double area = 0.02 * 0.02;
  const Vec3 square = impulse_on(w, blast, id);
  CHECK(square.isApprox(Vec3(0, 0, 2.0 * area * free_impulse(1e5, 10.0)), 1e-4));
  // From 60 degrees aside: 1 + 3/4 - 1, along the normal still.
  const Blast aside{Vec3(10.0 * std::sqrt(3.0), 0, 0), 1e5, 0.0};
  const Vec3 leaning = impulse_on(w, aside, id);
  CHECK(leaning.isApprox(Vec3(0, 0, 0.75 * area * free_impulse(1e5, 20.0)), 1e-3));
}

TEST_CASE("the impulse goes with the inverse of the distance and the power 2/3 of the energy") {
  CHECK(free_impulse(1e5, 4.0) == Approx(free_impulse(1e5, 1.0) / 4.0));
  CHECK(free_impulse(8e5, 1.0) == Approx(4.0 * free_impulse(1e5, 1.0)));
  CHECK(free_impulse(4.184e6, 1.0) == Approx(200.0));  // a kilogram of TNT at a metre
  CHECK(blast_duration(4.184e6, 1.0) == Approx(1.2e-3));
}

TEST_CASE("a ball far off takes what its lit half takes: pi r2 i times the mean over the disc") {
  world::World w = make_world();
  const auto id = add(w, world::SphereDescription{0.05}, Vec3(20, 0, 0));
  const Vec3 impulse = impulse_on(w, {Vec3::Zero(), 1e4, 0.0}, id);
  // Over the half sphere: 2 pi r2 times the integral of (1 + 3c2 - 2c) c dc = 2 pi r2 (1/2 + 3/4 - 2/3).
  const double disc = 2.0 * core::kPi * 0.05 * 0.05 * (0.5 + 0.75 - 2.0 / 3.0);
  CHECK(impulse.x() == Approx(disc * free_impulse(1e4, 20.0)).epsilon(0.01));
  CHECK(std::abs(impulse.y()) + std::abs(impulse.z()) < 1e-9 * impulse.x());
}

TEST_CASE("who stands behind another is spared, by a floor as well") {
  world::World w = make_world();
  add(w, world::BoxDescription{Vec3(0.05, 1, 1)}, Vec3(1, 0, 0));
  const auto behind = add(w, world::SphereDescription{0.1}, Vec3(2, 0, 0));
  const auto beside = add(w, world::SphereDescription{0.1}, Vec3(0, 0, 2));
  const auto shell = add(w, pane(0.2, 0.05, false), Vec3(2, 0, 0.5));
  const Blast blast{Vec3::Zero(), 1e5, 0.0};
  CHECK(impulse_on(w, blast, behind).norm() == 0.0);
  CHECK(impulse_on(w, blast, shell).norm() == 0.0);
  CHECK(impulse_on(w, blast, beside).norm() > 0.0);
  add(w, world::PlaneDescription{}, Vec3(0, 0.5, 0));  // the blast is in the ground
  CHECK(impulse_on(w, blast, beside).norm() == 0.0);
}

TEST_CASE("a closed shell takes a blast on the side that it turns to it, or from within on all sides") {
  world::World w = make_world();
  world::ShellDescription ball;
  ball.mesh = geometry::make_sphere(0.1, {0.02, 0.0, 1}).value();
  ball.is_breakable = false;
  const auto id = add(w, ball, Vec3(5, 0, 0));
  const Vec3 outside = impulse_on(w, {Vec3::Zero(), 1e4, 0.0}, id);
  const double disc = 2.0 * core::kPi * 0.01 * (0.5 + 0.75 - 2.0 / 3.0);
  CHECK(outside.x() == Approx(disc * free_impulse(1e4, 4.93)).epsilon(0.03));
  const Vec3 inside = impulse_on(w, {Vec3(5, 0, 0), 10.0, 0.0}, id);
  CHECK(inside.norm() < 0.02 * 4.0 * core::kPi * 0.01 * 2.0 * free_impulse(10.0, 0.1));
}

TEST_CASE("a body takes no more energy than goes its way") {
  world::World w = make_world();
  const auto id = add(w, pane(0.1, 0.01, false), Vec3(0, 0, 0.02));
  const Vec3 impulse = impulse_on(w, {Vec3::Zero(), 10.0, 0.0}, id);
  const double mass = body::find_body({w.bodies().begin(), w.bodies().end()}, id)->shape->mass;
  CHECK(0.5 * impulse.squaredNorm() / mass <= 10.0 * 0.5);
}

TEST_CASE("an explosion drives bodies apart by their impulses over their masses, at any step") {
  for (const int rate : {60, 240, 960}) {
    world::World w = make_world(rate);
    const auto id = add(w, world::SphereDescription{0.05}, Vec3(0, 0, 1));
    const Blast blast{Vec3::Zero(), 1e5, 0.0};
    const Vec3 impulse = impulse_on(w, blast, id);
    w.explode(blast);
    w.step();
    const body::Body& ball = w.bodies()[0];
    CHECK(ball.velocity.isApprox(impulse / ball.shape->mass, 1e-12));
    CHECK(w.impulse_log().size() > 3);
    w.step();  // and then no more
    CHECK(ball.velocity.isApprox(impulse / ball.shape->mass, 1e-12));
    CHECK(w.impulse_log().empty());
  }
}

TEST_CASE(
    "a pane breaks by a near blast and holds against a far one, held or free, and the verdict says so") {
  for (const bool is_held : {false, true}) {
    const auto play = [&](double distance, int rate) {
      world::World w = make_world(rate);
      world::BodyDescription description;
      world::ShellDescription shell = pane(1.0, 0.05, true);
      if (is_held)
        for (std::size_t v = 0; v < shell.mesh.positions.size(); ++v)
          if (shell.mesh.positions[v].cwiseAbs().maxCoeff() > 0.499)
            shell.clamped.push_back(static_cast<int>(v));
      description.form = shell;
      description.material = 1;
      REQUIRE(w.add_body(description).ok());
      w.explode({Vec3(0.1, 0.05, distance), 4e5, 0.0});
      w.step();
      return w;
    };
    INFO("held: " << is_held);
    const world::World near = play(1.0, 240);
    REQUIRE(near.report().breaks.size() > 0);
    CHECK(near.bodies().size() > 3);
    CHECK(near.report().impacts[0].duration == Approx(blast_duration(4e5, 1.0)).epsilon(0.2));
    // What came loose goes with the blast.
    double forward = 0.0;
    for (const body::Body& piece : near.bodies()) forward += piece.is_dynamic() ? piece.velocity.z() : 0.0;
    CHECK(forward < 0.0);
    const world::World far = play(100.0, 240);
    CHECK(far.report().breaks.empty());
    // The stress does not depend on the step.
    const world::World other = play(20.0, 960), same = play(20.0, 120);
    REQUIRE(other.report().impacts.size() == same.report().impacts.size());
    if (!other.report().impacts.empty())
      CHECK(other.report().impacts[0].ratio == Approx(same.report().impacts[0].ratio).epsilon(1e-6));
  }
}
