#include "engine/dynamics/free_motion.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "sandbox/study/spin_top.h"
#include "tests/engine/dynamics/bodies.h"

namespace shatterbox {
namespace {

test::Scene top_scene(const Vec3& spin_body) {
  test::Scene scene;
  scene.settings.gravity.setZero();
  auto b = test::make_box(Vec3::Constant(0.5), Vec3(1, 2, 3));
  auto shape = std::make_shared<body::Shape>(*b.shape);
  shape->mass = 1.0;
  shape->inertia = Vec3(1, 2, 3).asDiagonal();
  b.shape = shape;
  b.inverse_mass = 1.0;
  b.inverse_inertia = shape->inertia.inverse();
  b.angular_velocity = spin_body;
  scene.add(b);
  return scene;
}

}  // namespace

TEST_CASE("a body in flight follows the parabola") {
  for (const double dt : {1.0 / 30, 1.0 / 240, 1.0 / 3840}) {
    test::Scene scene;
    scene.settings.time_step = dt;
    auto& b = scene.add(test::make_box(Vec3(0.1, 0.2, 0.3), Vec3(1, 50, 2)));
    b.velocity = Vec3(3, 10, -2);
    b.angular_velocity = Vec3(1, 2, 3);
    const int steps = static_cast<int>(std::lround(2.0 / dt));
    for (int i = 0; i < steps; ++i) scene.step();
    const Vec3 exact = Vec3(1, 50, 2) + 2.0 * Vec3(3, 10, -2) + 2.0 * scene.settings.gravity;
    CHECK((scene.bodies[0].pose.translation - exact).norm() < 1e-11);
    CHECK((scene.bodies[0].velocity - Vec3(3, 10, -2) - 2.0 * scene.settings.gravity).norm() < 1e-11);
  }
}

TEST_CASE("an asymmetric top follows Jacobi's functions for 100 s") {
  // Landau & Lifshitz sec. 37 with L^2 > 2 E I2: spin along axes 1 (least), 2, 3 (greatest).
  const Vec3 moments(1, 2, 3);
  const Vec3 start(0.4, 0.0, 1.3);
  auto scene = top_scene(start);
  const sandbox::study::SpinTop top(moments, start.x(), start.z());
  const Vec3 momentum = scene.spin();
  const double energy = scene.kinetic();
  double worst_angle = 0.0, worst_momentum = 0.0, worst_energy = 0.0;
  for (int i = 1; i <= 24000; ++i) {
    scene.step();
    const auto& b = scene.bodies[0];
    const Vec3 exact = top.spin_at(i / 240.0);
    const Vec3 found = b.pose.rotation.conjugate() * b.angular_velocity;
    worst_angle = std::max(worst_angle, (found - exact).norm() / exact.norm());
    worst_momentum = std::max(worst_momentum, (scene.spin() - momentum).norm() / momentum.norm());
    worst_energy = std::max(worst_energy, std::abs(scene.kinetic() - energy) / energy);
  }
  INFO("angle " << worst_angle << " momentum " << worst_momentum << " energy " << worst_energy);
  CHECK(worst_angle < 1e-5);
  CHECK(worst_momentum < 1e-10);
  CHECK(worst_energy < 1e-9);
  WARN("top, 100 s: angle " << worst_angle << ", momentum " << worst_momentum << ", energy " << worst_energy);
}

TEST_CASE("a spin of 1e4 rad/s keeps momentum and energy") {
  auto scene = top_scene(Vec3(1e4, 50.0, -2e3));
  const Vec3 momentum = scene.spin();
  const double energy = scene.kinetic();
  for (int i = 0; i < 240; ++i) scene.step();
  CHECK((scene.spin() - momentum).norm() < 1e-10 * momentum.norm());
  CHECK(std::abs(scene.kinetic() - energy) < 1e-6 * energy);
}

}  // namespace shatterbox
