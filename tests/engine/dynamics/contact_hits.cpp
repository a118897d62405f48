// What of a contact's impulses is logged as a hit, where something may break.
#include <algorithm>
#include <catch2/catch.hpp>
#include <vector>

#include "tests/engine/dynamics/bodies.h"

using namespace shatterbox;

namespace {

struct Given {
  double hit = 0.0, pressed = 0.0;  // N s
  std::vector<double> arrivals;     // s
};

/// A box of a kilogram comes down flat at 1 m/s, with `force` (N) on it, on a floor from which it does not
/// bounce. Sums over so long, s.
Given press_down(double rate, double force, double seconds) {
  test::Scene scene;
  scene.settings.time_step = 1.0 / rate;
  scene.settings.has_sleep = false;
  scene.add(test::make_plane()).restitution = 0.0;
  auto box = test::make_box(Vec3(0.05, 0.05, 0.05), Vec3(0.0, 0.0513, 0.0), true, 1000.0);
  box.velocity = Vec3(0.0, -1.0, 0.0);
  box.force = Vec3(0.0, -force, 0.0);
  box.restitution = 0.0;
  box.may_break = true;
  scene.add(box);
  Given given;
  for (int i = 0; i < seconds * rate; ++i) {
    scene.step();
    for (const body::LoggedImpulse& entry : scene.log) {
      if (entry.kind == body::ImpulseKind::contact) given.pressed += std::abs(entry.impulse_world.y());
      if (entry.kind != body::ImpulseKind::collision) continue;
      given.hit += std::abs(entry.impulse_world.y());
      if (entry.closing_speed > 0.0) given.arrivals.push_back(i / rate + entry.time);
    }
  }
  return given;
}

}  // namespace

TEST_CASE("what presses on behind a hit is no part of it, however long the step is") {
  const double force = 300.0, seconds = 0.1;
  for (const double rate : {30.0, 60.0, 120.0, 240.0, 960.0}) {
    const Given given = press_down(rate, force, seconds);
    CAPTURE(rate, given.hit, given.pressed, given.arrivals);
    // The hit's own impulse is mass by speed, some 1.05 N s; for 2 ms, or a substep, the force is in it too.
    CHECK(given.hit > 1.0);
    CHECK(given.hit < 1.1 + force * (2.0 / 480.0));
    // Together they stop the box and bear it from then on.
    const double all = 1.0 + (force + 9.81) * seconds;
    CHECK(given.hit + given.pressed == Approx(all).epsilon(0.01));
    REQUIRE_FALSE(given.arrivals.empty());
    CHECK(*std::min_element(given.arrivals.begin(), given.arrivals.end()) < 0.003);
  }
}

TEST_CASE("what bounces to and fro hits each time, also within one step") {
  const double speed = 0.5, restitution = 0.9, play = 0.002;  // m/s; m, over the box
  test::Scene scene;
  scene.settings.time_step = 0.016;
  scene.settings.substeps = 32;
  scene.settings.has_sleep = false;
  scene.settings.gravity.setZero();
  const body::BodyId floor = scene.add(test::make_plane()).id;
  scene.add(test::make_box(Vec3(0.2, 0.05, 0.2), Vec3(0.0, 0.15 + play, 0.0), false));
  auto box = test::make_box(Vec3(0.05, 0.05, 0.05), Vec3(0.0, 0.0505, 0.0));
  box.velocity = Vec3(0.0, -speed, 0.0);
  box.may_break = true;
  scene.add(box);
  for (body::Body& body : scene.bodies) body.restitution = restitution;
  scene.step();
  double down = 0.0, down_again = 0.0;  // N s: of the floor
  std::vector<double> arrivals;         // s
  for (const body::LoggedImpulse& entry : scene.log) {
    CHECK(entry.kind == body::ImpulseKind::collision);
    if (entry.body_a != floor && entry.body_b != floor) continue;
    arrivals.push_back(entry.time);
    (entry.time < 0.005 ? down : down_again) += std::abs(entry.impulse_world.y());
  }
  std::sort(arrivals.begin(), arrivals.end());
  CAPTURE(arrivals, down, down_again);
  REQUIRE(arrivals.size() == 8);  // four corners
  CHECK(arrivals[3] == Approx(0.001).margin(0.0005));
  CHECK(arrivals[4] == Approx(0.001 + play / 0.45 + play / 0.405).margin(0.0015));
  CHECK(down == Approx(0.5 * 1.9).epsilon(0.02));
  CHECK(down_again == Approx(0.405 * 1.9).epsilon(0.02));
}
