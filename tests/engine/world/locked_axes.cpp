// What is left of a thing that is held along some axes, and what breaks off it.
#include <catch2/catch.hpp>
#include <map>

#include "engine/geometry/generators.h"
#include "engine/world/world.h"

using namespace shatterbox;

namespace {

constexpr double kHeld = 0.03;  // m: where on z

/// A pane that stays in its plane, and a steel ball on its way to a place on it.
world::World make_throw(const Vec3& place, double radius, double speed) {
  world::World w{world::WorldSettings{}};
  const int glass = w.add_material(*material::find_preset("glass")).value();
  const int steel = w.add_material(*material::find_preset("steel")).value();
  world::BodyDescription pane;
  world::ShellDescription shell;
  shell.mesh = geometry::make_pane(0.3, 0.3, {0.015, 0.0, 1}).value();
  shell.thickness = 0.003;
  pane.form = shell;
  pane.material = glass;
  pane.pose.translation = Vec3(0, 1.0, kHeld);
  pane.velocity = Vec3(0.3, 0.5, 7.0);  // along z it is held
  pane.angular_velocity = Vec3(1.0, 2.0, 3.0);
  pane.locked = {{false, false, true}, {true, true, false}};
  REQUIRE(w.add_body(pane).ok());
  world::BodyDescription ball;
  ball.form = world::SphereDescription{radius};
  ball.material = steel;
  ball.pose.translation = pane.pose.translation + place + Vec3(0, 0, 0.02);
  ball.velocity = Vec3(0, 0, -speed);
  REQUIRE(w.add_body(ball).ok());
  return w;
}

}  // namespace

TEST_CASE("a piece with more than half of what was held is held as it was and the others are free") {
  for (const bool is_hit_at_corner : {true, false}) {
    world::World w = is_hit_at_corner ? make_throw(Vec3(0.13, 0.13, 0), 0.006, 20.0)
                                      : make_throw(Vec3::Zero(), 0.01, 20.0);
    CHECK(w.bodies()[0].velocity == Vec3(0.3, 0.5, 0.0));
    CHECK(w.bodies()[0].angular_velocity == Vec3(0.0, 0.0, 3.0));
    const double mass = w.bodies()[0].shape->mass;
    for (int i = 0; i < 60 && w.report().breaks.empty(); ++i) w.step();
    REQUIRE_FALSE(w.report().breaks.empty());
    std::map<body::BodyId, double> held;  // where on z
    for (const body::Body& b : w.bodies()) {
      CHECK(b.locked.any() == (b.shape->mass > 0.5 * mass));
      if (b.locked.any()) held[b.id] = b.pose.translation.z();
    }
    CHECK(held.size() == (is_hit_at_corner ? 1 : 0));
    for (int i = 0; i < 60; ++i) w.step();
    for (const body::Body& b : w.bodies()) {
      if (!b.locked.any()) continue;
      CHECK(b.pose.translation.z() == held[b.id]);
      CHECK(b.velocity.z() == 0.0);
      CHECK(b.angular_velocity.x() == 0.0);
    }
    CHECK(w.report().conservation.momentum_error < 1e-9);
    for (const world::BreakRow& row : w.report().breaks) CHECK(row.momentum_error < 1e-12);
  }
}

TEST_CASE("a push, a hand and an explosion move nothing along what is locked and leave momentum explained") {
  world::WorldSettings settings;
  world::World w{settings};
  REQUIRE(w.add_material(*material::find_preset("concrete")).ok());
  world::BodyDescription box;
  box.form = world::BoxDescription{Vec3(0.1, 0.05, 0.05)};
  box.locked = {{false, true, true}, {true, true, true}};
  box.force = Vec3(0, 5, 5);
  const body::BodyId id = w.add_body(box).value();
  CHECK(w.push_body(id, Vec3(0.2, 3.0, -4.0), Vec3(0.1, 0.05, 0.05)));
  const int hand = w.grab(id, Vec3(0.1, 0, 0), 1e3);
  for (int i = 0; i < 60; ++i) {
    w.move_hand(hand, Vec3(0.1 + 0.005 * i, 0.004 * i, 0));
    if (i == 30) w.explode({Vec3(-0.5, 0.3, 0.2), 1e4, 0.0});
    w.step();
  }
  const body::Body& moved = w.bodies()[0];
  CHECK(moved.pose.translation.x() > 0.2);
  CHECK(moved.pose.translation.y() == 0.0);
  CHECK(moved.pose.translation.z() == 0.0);
  CHECK(moved.angular_velocity.norm() == 0.0);
  CHECK(w.report().conservation.momentum_error < 1e-12 * moved.shape->mass * 100.0);
}

TEST_CASE("what may break and is locked along the ways that floors lie is prepared for the others") {
  world::World w{world::WorldSettings{}};
  REQUIRE(w.add_material(*material::find_preset("glass")).ok());
  world::BodyDescription pane;
  world::ShellDescription shell;
  shell.mesh = geometry::make_pane(0.3, 0.3, {0.03, 0.0, 1}).value();
  shell.thickness = 0.003;
  pane.form = shell;
  pane.locked = {{true, true, false}, {true, true, true}};
  REQUIRE(w.add_body(pane).ok());
  w.prepare();
  const body::Body& body = w.bodies()[0];
  CHECK(body.mobility(Vec3(0.1, 0.1, 0), Vec3::UnitX()) == 0.0);
  CHECK(body.mobility(Vec3(0.1, 0.1, 0), Vec3::UnitZ()) == Approx(body.inverse_mass));
}
