// Bodies that a force or a torque of their own acts on, against closed forms.
#include <catch2/catch.hpp>

#include "engine/geometry/generators.h"
#include "engine/world/world.h"

using namespace shatterbox;

namespace {

world::World make_world(const Vec3& gravity, double friction = 0.5) {
  world::WorldSettings settings;
  settings.gravity = gravity;
  world::World w{settings};
  material::Material stone = *material::find_preset("concrete");
  stone.friction = friction;
  REQUIRE(w.add_material(stone).ok());
  return w;
}

world::BodyDescription make_box(const Vec3& place) {
  world::BodyDescription box;
  box.form = world::BoxDescription{Vec3(0.1, 0.05, 0.05)};
  box.pose.translation = place;
  return box;
}

}  // namespace

TEST_CASE("a force accelerates as gravity of its own would and its work is in the energy") {
  world::World w = make_world(Vec3(0, -9.81, 0));
  world::BodyDescription box = make_box(Vec3(0, 100, 0));
  box.force = Vec3(300, 50, 0);
  REQUIRE(w.add_body(box).ok());
  const double mass = w.bodies()[0].shape->mass;
  for (int i = 0; i < 240; ++i) w.step();
  const Vec3 expected = Vec3(0, 100, 0) + 0.5 * (Vec3(0, -9.81, 0) + box.force / mass);
  CHECK((w.bodies()[0].pose.translation - expected).norm() < 1e-9);
  CHECK(w.report().conservation.greatest_energy_rise < 1e-9 * mass * 9.81 * 100);
  CHECK(w.report().conservation.momentum_error < 1e-9 * mass);
}

TEST_CASE("a force below what friction holds moves nothing and one above it does as theory says") {
  for (const double share : {0.9, 1.2}) {
    world::World w = make_world(Vec3(0, -9.81, 0), 0.4);
    world::BodyDescription floor;
    floor.form = world::PlaneDescription{};
    REQUIRE(w.add_body(floor).ok());
    world::BodyDescription box = make_box(Vec3(0, 0.0501, 0));
    REQUIRE(w.add_body(box).ok());
    const double mass = w.bodies()[1].shape->mass, holds = 0.4 * mass * 9.81;
    box.pose.translation.z() = 1.0;
    box.force = Vec3(share * holds, 0, 0);
    REQUIRE(w.add_body(box).ok());
    for (int i = 0; i < 240; ++i) w.step();
    const double moved = w.bodies()[2].pose.translation.x();
    INFO(share);
    if (share < 1.0)
      CHECK(std::abs(moved) < 1e-4);
    else
      CHECK(moved == Approx(0.5 * (share - 1.0) * holds / mass).epsilon(0.01));
    CHECK(w.report().conservation.momentum_error < 1e-9 * mass);
  }
}

TEST_CASE("a torque about a principal axis spins up evenly") {
  world::World w = make_world(Vec3::Zero());
  world::BodyDescription box = make_box(Vec3::Zero());
  box.torque = Vec3(0, 0, 2.0);
  REQUIRE(w.add_body(box).ok());
  const double moment = w.bodies()[0].shape->inertia(2, 2);
  for (int i = 0; i < 120; ++i) w.step();
  CHECK(w.bodies()[0].angular_velocity.z() == Approx(2.0 * 0.5 / moment).epsilon(1e-9));
  CHECK(w.bodies()[0].angular_velocity.head<2>().norm() < 1e-9);
}

TEST_CASE("the pieces of what breaks share its force by mass") {
  world::WorldSettings settings;
  world::World w{settings};
  REQUIRE(w.add_material(*material::find_preset("glass")).ok());
  world::BodyDescription floor;
  floor.form = world::PlaneDescription{};
  REQUIRE(w.add_body(floor).ok());
  world::BodyDescription ball;
  world::ShellDescription shell;
  shell.mesh = geometry::make_sphere(0.04, {0.012, 0.0, 1}).value();
  shell.thickness = 0.0006;
  ball.form = shell;
  ball.pose.translation = Vec3(0, 0.08, 0);
  ball.velocity = Vec3(0, -8, 0);
  ball.force = Vec3(0.5, 0, 0);
  ball.torque = Vec3(0, 1e-5, 0);
  REQUIRE(w.add_body(ball).ok());
  for (int i = 0; i < 6; ++i) w.step();
  REQUIRE(w.report().breaks.size() > 0);
  Vec3 sum = Vec3::Zero();
  for (const body::Body& b : w.bodies()) {
    sum += b.force;
    CHECK(b.torque.norm() == 0.0);
  }
  CHECK((sum - ball.force).norm() < 1e-9);
  CHECK(w.report().conservation.momentum_error < 1e-9);
}
