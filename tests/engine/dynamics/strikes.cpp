// Hits that run on through what touches, or nearly so: closed forms of balls that meet one after the other.
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/engine/dynamics/bodies.h"

namespace shatterbox {
namespace {

constexpr double kBallRadius = 0.05;  // m

/// `count` balls in a row along x with `gap` between them, and `moving` more that come at 1 m/s, together.
test::Scene row_scene(int count, int moving, double gap, double restitution, int rate) {
  test::Scene scene;
  scene.settings.gravity.setZero();
  scene.settings.time_step = 1.0 / rate;
  for (int i = -moving; i < count; ++i) {
    auto ball =
        test::make_sphere(kBallRadius, Vec3((2.0 * kBallRadius + gap) * i - (i < 0 ? 0.1037 : 0.0), 0, 0));
    ball.velocity.x() = i < 0 ? 1.0 : 0.0;
    ball.restitution = restitution;
    scene.add(ball);
  }
  return scene;
}

double kinetic_of(const test::Scene& scene) {
  double sum = 0.0;
  for (const auto& ball : scene.bodies) sum += ball.velocity.squaredNorm();
  return sum;
}

}  // namespace

TEST_CASE("as many balls leave an elastic row as hit it, whether they touch or not") {
  for (const int rate : {60, 240, 960})
    for (const double gap : {1e-5, 1e-3, 7e-3})
      for (const int moving : {1, 2}) {
        INFO(rate << " steps a second, gaps of " << gap << " m, " << moving << " in");
        test::Scene scene = row_scene(5, moving, gap, 1.0, rate);
        for (int i = 0; i < rate / 2; ++i) scene.step();
        const int last = static_cast<int>(scene.bodies.size()) - 1;
        for (int k = 0; k <= last; ++k)
          CHECK(scene.bodies[static_cast<std::size_t>(k)].velocity.x() ==
                Approx(k > last - moving ? 1.0 : 0.0).margin(2e-3));
        CHECK(kinetic_of(scene) == Approx(moving).epsilon(2e-3));
      }
}

TEST_CASE("a hit runs through a row whose balls drift") {
  // What drifts towards another by a fraction of a millimetre a second must not share the blow.
  for (const int rate : {60, 240, 960})
    for (const double drift : {2e-4, 1e-3, 1e-2})
      for (const int drifter : {2, 3, 4}) {
        test::Scene scene = row_scene(5, 1, 1e-5, 1.0, rate);
        // They meet just when the hit comes.
        for (int k = drifter; k <= 5; ++k)
          scene.bodies[static_cast<std::size_t>(k)].pose.translation.x() += 0.1037 * drift;
        for (int k = drifter; k <= 5; ++k) scene.bodies[static_cast<std::size_t>(k)].velocity.x() = -drift;
        for (int i = 0; i < rate / 2; ++i) scene.step();
        INFO(rate << " steps a second, ball " << drifter << " and those behind it drift at " << drift);
        CHECK(scene.bodies.back().velocity.x() == Approx(1.0).margin(2e-3 + 2.0 * drift));
      }
}

TEST_CASE("of a row that is not elastic the last ball has what ball by ball is handed on") {
  for (const int rate : {60, 240})
    for (const double restitution : {0.5, 0.9}) {
      test::Scene scene = row_scene(5, 1, 1e-5, restitution, rate);
      double momentum = 0.0;
      for (int i = 0; i < rate / 4; ++i) scene.step();
      for (const auto& ball : scene.bodies) momentum += ball.velocity.x();
      INFO(rate << " steps a second, restitution " << restitution);
      CHECK(momentum == Approx(1.0).epsilon(1e-12));
      CHECK(scene.bodies.back().velocity.x() == Approx(std::pow(0.5 + 0.5 * restitution, 5)).epsilon(5e-3));
      CHECK(kinetic_of(scene) < 1.0);
    }
}

TEST_CASE("a light ball on a heavy one is thrown up when both have fallen") {
  for (const int rate : {60, 240, 960})
    for (const double gap : {1e-5, 2e-3}) {
      test::Scene scene;
      scene.settings.time_step = 1.0 / rate;
      scene.add(test::make_plane());
      scene.add(test::make_sphere(0.1, Vec3(0, 0.6, 0), 1000.0));
      scene.add(test::make_sphere(0.05, Vec3(0, 0.75 + gap, 0), 1000.0));
      for (auto& body : scene.bodies) body.restitution = 1.0;
      double highest = 0.0;
      for (int i = 0; i < rate; ++i) {
        scene.step();
        highest = std::max(highest, scene.bodies[2].pose.translation.y());
      }
      // Both fall by half a metre; the lower one turns, and throws the other at (3 M - m) / (M + m) the
      // speed.
      const double ratio = (3.0 * 8.0 - 1.0) / (8.0 + 1.0);
      INFO(rate << " steps a second, gap of " << gap << " m");
      CHECK(highest == Approx(0.25 + 0.5 * ratio * ratio).epsilon(0.03));
    }
}

TEST_CASE("only what has given an impulse is logged") {
  // A heavy ball runs into boxes on a floor: many a one is pressed in one sweep and not in the next.
  core::Random random(7);
  int given = 0;
  for (int trial = 0; trial < 8; ++trial) {
    test::Scene scene;
    scene.settings.time_step = 1.0 / 60.0;
    scene.add(test::make_plane());
    for (int i = 0; i < 12; ++i) {
      auto& box = scene.add(
          test::make_box(Vec3::Constant(0.05), Vec3(0.11 * (i % 4), 0.06 + 0.105 * (i / 4), 0), true, 500.0));
      box.angular_velocity.x() = random.uniform(-1, 1);
    }
    auto ball = test::make_sphere(0.1, Vec3(-0.3, 0.11 + 0.02 * trial, 0), 8000.0);
    ball.velocity.x() = 20.0;
    scene.add(ball);
    for (int i = 0; i < 30; ++i) {
      scene.step();
      for (const auto& entry : scene.log) {
        if (entry.kind != body::ImpulseKind::collision && entry.kind != body::ImpulseKind::contact) continue;
        ++given;
        CHECK(entry.impulse_a.norm() > 0.5 * entry.impulse_world.norm());
        CHECK(entry.impulse_b.norm() > 0.5 * entry.impulse_world.norm());
      }
    }
  }
  CHECK(given > 1000);
}

TEST_CASE("a ball that meets a sheet squarely bounces straight back, whenever in the step it arrives") {
  // Triangles smaller than the ball, and a step in which it goes further than its radius.
  constexpr double kRadius = 0.015;
  for (const double speed : {2.5, 10.0, 40.0})
    for (int phase = 0; phase < 12; ++phase) {
      test::Scene scene;
      scene.settings.gravity.setZero();
      scene.add(test::make_shell(test::square_mesh(0.1, 20), false));
      const double way = speed * scene.settings.time_step;
      scene.add(test::make_sphere(kRadius, Vec3(0.003, kRadius + way * (2.0 + phase / 12.0), 0.002)));
      scene.bodies[0].restitution = scene.bodies[1].restitution = 0.5;
      scene.bodies[1].velocity = Vec3(0, -speed, 0);
      for (int i = 0; i < 6; ++i) scene.step();
      INFO(speed << " m/s, phase " << phase);
      const Vec3 after = scene.bodies[1].velocity;
      CHECK(after.y() == Approx(0.5 * speed).epsilon(1e-3));
      CHECK(std::hypot(after.x(), after.z()) < 1e-3 * speed);
    }
}

}  // namespace shatterbox
