// Hands that hold bodies: where they are led, against what holds them back.
#include "engine/dynamics/hand.h"

#include <catch2/catch.hpp>

#include "engine/geometry/generators.h"
#include "engine/world/world.h"

using namespace shatterbox;

namespace {

struct Held {
  world::World w;
  body::BodyId id = 0;
  int hand = 0;

  Held(int rate, double most_force, const Vec3& grip = Vec3::Zero()) : w(settings_of(rate)) {
    REQUIRE(w.add_material(*material::find_preset("steel")).ok());
    world::BodyDescription box;
    box.form = world::BoxDescription{Vec3(0.1, 0.05, 0.05)};
    box.density = 500.0;  // 1 kg
    box.pose.translation = Vec3(0, 1, 0);
    id = w.add_body(box).value();
    hand = w.grab(id, Vec3(0, 1, 0) + grip, most_force);
    REQUIRE(hand != 0);
  }
  static world::WorldSettings settings_of(int rate) {
    world::WorldSettings settings;
    settings.steps_per_second = rate;
    return settings;
  }
  const body::Body& body() const { return *body::find_body(bodies(), id); }
  const std::vector<body::Body>& bodies() const {
    copy.assign(w.bodies().begin(), w.bodies().end());
    return copy;
  }
  mutable std::vector<body::Body> copy;
};

}  // namespace

TEST_CASE("a hand holds a body in its place and attitude, at its middle or at an end") {
  for (const int rate : {60, 240, 2000})
    for (const Vec3& grip : {Vec3(0, 0, 0), Vec3(0.1, 0.05, 0)}) {
      Held held(rate, 200.0, grip);
      for (int i = 0; i < rate; ++i) held.w.step();
      INFO(rate << " steps a second");
      CHECK((held.body().pose.translation - Vec3(0, 1, 0)).norm() < 2e-3);
      CHECK(held.body().pose.rotation.angularDistance(Quat::Identity()) < 0.02);
      CHECK(held.body().velocity.norm() < 10.0 / rate);  // half of what gravity gives in a step
    }
}

TEST_CASE("a hand leads a body along, a little behind, and it flies on when it is let go") {
  Held held(240, 500.0);
  for (int i = 1; i <= 240; ++i) {
    REQUIRE(held.w.move_hand(held.hand, Vec3(i / 240.0, 1, 0)));
    held.w.step();
  }
  CHECK((held.body().pose.translation - Vec3(1, 1, 0)).norm() < 0.01);
  CHECK(held.body().velocity.x() == Approx(1.0).epsilon(0.01));
  held.w.release(held.hand);
  const Vec3 start = held.body().pose.translation, velocity = held.body().velocity;
  for (int i = 0; i < 120; ++i) held.w.step();
  const Vec3 expected = start + 0.5 * velocity + 0.125 * Vec3(0, -9.81, 0);
  CHECK((held.body().pose.translation - expected).norm() < 1e-9);
  CHECK_FALSE(held.w.move_hand(held.hand, Vec3::Zero()));
}

TEST_CASE("a hand that is told its place twice before a step has gone there once") {
  Held once(240, 500.0), twice(240, 500.0);
  for (int i = 1; i <= 60; ++i) {
    const Vec3 place(i / 240.0, 1, 0);
    REQUIRE(once.w.move_hand(once.hand, place));
    once.w.step();
    REQUIRE(twice.w.move_hand(twice.hand, Vec3(0.3, 1.2, 0)));
    REQUIRE(twice.w.move_hand(twice.hand, place));
    REQUIRE(twice.w.move_hand(twice.hand, place));
    twice.w.step();
  }
  CHECK((twice.body().pose.translation - once.body().pose.translation).norm() < 1e-9);
  CHECK((twice.body().velocity - once.body().velocity).norm() < 1e-9);
}

TEST_CASE("a hand too weak for the weight lets the body sink at what is left of gravity") {
  Held held(240, 5.0);
  for (int i = 0; i < 120; ++i) held.w.step();
  CHECK(held.body().velocity.y() == Approx(-0.5 * (9.81 - 5.0)).epsilon(1e-6));
}

TEST_CASE("what stands in the way holds a led body back, and the hand's force does not exceed its limit") {
  Held held(240, 30.0);
  world::BodyDescription wall;
  wall.form = world::BoxDescription{Vec3(0.1, 1, 1)};
  wall.motion = body::Motion::fixed;
  wall.pose.translation = Vec3(0.5, 1, 0);
  REQUIRE(held.w.add_body(wall).ok());
  for (int i = 1; i <= 480; ++i) {
    REQUIRE(held.w.move_hand(held.hand, Vec3(i / 240.0, 1, 0)));
    held.w.step();
    for (const body::LoggedImpulse& entry : held.w.impulse_log())
      if (entry.body_b == 0) CHECK(entry.impulse_world.norm() <= 30.0 / 240.0 * (1.0 + 1e-9));
  }
  CHECK(held.body().pose.translation.x() < 0.3);
  CHECK(held.body().pose.translation.x() > 0.29);
  const Vec3 pressed = held.body().pose.translation;
  for (int i = 0; i < 120; ++i) held.w.step();
  CHECK(std::abs(held.body().pose.translation.x() - pressed.x()) < 1e-4);
  CHECK(held.body().pose.translation.y() > 0.95);  // it creeps down the wall: nearly all force goes into it
}

TEST_CASE("gravity that changes wakes what rests, and acts at once") {
  world::World w{world::WorldSettings{}};
  REQUIRE(w.add_material(*material::find_preset("steel")).ok());
  world::BodyDescription floor;
  floor.form = world::PlaneDescription{};
  REQUIRE(w.add_body(floor).ok());
  world::BodyDescription box;
  box.form = world::BoxDescription{Vec3(0.1, 0.1, 0.1)};
  box.pose.translation = Vec3(0, 0.1, 0);
  REQUIRE(w.add_body(box).ok());
  for (int i = 0; i < 240; ++i) w.step();
  CHECK_FALSE(w.bodies()[1].is_awake);
  w.set_gravity(Vec3(0, 2, 0));
  const double start = w.bodies()[1].pose.translation.y();
  for (int i = 0; i < 240; ++i) w.step();
  CHECK(w.bodies()[1].pose.translation.y() - start == Approx(1.0).epsilon(1e-3));
}

TEST_CASE("a hand whose body breaks keeps the piece at its grip, and the others fly") {
  world::WorldSettings settings;
  settings.gravity.setZero();
  world::World w(settings);
  REQUIRE(w.add_material(*material::find_preset("glass")).ok());
  world::BodyDescription pane;
  world::ShellDescription shell;
  shell.mesh = geometry::make_pane(1.0, 1.0, {0.05, 0.0, 1}).value();  // in the plane z = 0
  shell.thickness = 0.004;
  pane.form = shell;
  const auto id = w.add_body(pane).value();
  const Vec3 grip(0.5, 0.5, 0);
  const int hand = w.grab(id, grip, 500.0);
  REQUIRE(hand != 0);
  w.explode({Vec3(0.1, 0.05, 1.0), 4e5, 0.0});
  for (int i = 0; i < 60; ++i) {
    w.step();
    REQUIRE(w.move_hand(hand, grip));  // it holds something
  }
  REQUIRE(w.report().breaks.size() > 0);
  REQUIRE(w.bodies().size() > 3);
  double nearest = 1.0, farthest = 0.0;
  for (const body::Body& piece : w.bodies()) {
    farthest = std::max(farthest, (piece.pose.translation - grip).norm());
    for (const Vec3& p : piece.shape->surface.positions)
      nearest = std::min(nearest, (piece.pose.apply(p) - grip).norm());
  }
  CHECK(nearest < 0.01);
  CHECK(farthest > 0.2);
}
