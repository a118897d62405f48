// Capsules against closed forms, and against everything that they can meet.
#include <catch2/catch.hpp>
#include <cmath>

#include "engine/audit/audit.h"
#include "engine/geometry/closest_points.h"
#include "tests/engine/dynamics/bodies.h"
#include "tests/support/sanitized.h"

namespace shatterbox {
namespace {

constexpr double kRadius = 0.05, kHalfLength = 0.1;  // m

body::Body make_capsule(const Vec3& position) {
  return test::make_capsule(kRadius, kHalfLength, position);
}

/// With its axis along x or z.
Quat lying(const Vec3& axis) {
  return Quat::FromTwoVectors(Vec3::UnitY(), axis);
}

Vec3 end_of(const body::Body& b, double side) {
  return b.pose.apply(Vec3(0, side * b.shape->half_length, 0));
}

double gap_between(const body::Body& a, const body::Body& b) {
  return geometry::closest_between_segments(end_of(a, -1), end_of(a, 1), end_of(b, -1), end_of(b, 1))
             .distance -
         a.shape->radius - b.shape->radius;
}

test::Scene slope(double angle, double friction, const Vec3& axis) {
  test::Scene scene;
  scene.settings.gravity = 9.81 * Vec3(std::sin(angle), -std::cos(angle), 0);
  scene.add(test::make_plane()).friction = friction;
  const double gap = 2.0 * (kRadius + kHalfLength) * scene.settings.kept_gap;
  auto& capsule = scene.add(make_capsule(Vec3(0, kRadius + gap, 0)));
  capsule.friction = friction;
  capsule.pose.rotation = lying(axis);
  return scene;
}

Vec3 random_direction(core::Random& random) {
  for (;;) {
    const double x = random.uniform(-1.0, 1.0), y = random.uniform(-1.0, 1.0), z = random.uniform(-1.0, 1.0);
    const Vec3 way(x, y, z);
    if (way.norm() > 0.1 && way.norm() < 1.0) return way.normalized();
  }
}

/// One of two without weight, to the left or right, that lies somehow and spins, at `least` to `most` rad/s.
body::Body& add_flying(test::Scene& scene, double side, double least, double most, core::Random& random) {
  scene.settings.gravity.setZero();
  auto& capsule = scene.add(make_capsule(Vec3(0.2 * side, 0, 0)));
  capsule.pose.rotation = lying(random_direction(random));
  capsule.angular_velocity = random.uniform(least, most) * random_direction(random);
  return capsule;
}

}  // namespace

TEST_CASE("a capsule rolls down a slope across it and slides down along it as theory says") {
  const double angle = 0.3, slope_force = 9.81 * std::sin(angle), press = 9.81 * std::cos(angle);
  constexpr int kSteps = 240;
  {
    auto scene = slope(angle, 0.8, Vec3::UnitZ());
    for (int i = 0; i < kSteps; ++i) scene.step();
    const auto& b = scene.bodies[1];
    const double spin_inertia = b.shape->inertia(1, 1) / (b.shape->mass * kRadius * kRadius);
    CHECK(b.pose.translation.x() == Approx(0.5 * slope_force / (1.0 + spin_inertia)).epsilon(0.01));
    CHECK(b.angular_velocity.z() == Approx(-b.velocity.x() / kRadius).epsilon(0.01));
    CHECK(std::abs(end_of(b, 1).y() - end_of(b, -1).y()) < 1e-4 * kHalfLength);
  }
  {
    auto scene = slope(angle, 0.95 * std::tan(angle), Vec3::UnitX());
    for (int i = 0; i < kSteps; ++i) scene.step();
    const double expected = 0.5 * (slope_force - 0.95 * std::tan(angle) * press);
    CHECK(scene.bodies[1].pose.translation.x() == Approx(expected).epsilon(0.01));
  }
  {
    auto scene = slope(angle, 1.05 * std::tan(angle), Vec3::UnitX());
    for (int i = 0; i < kSteps; ++i) scene.step();
    CHECK(std::abs(scene.bodies[1].pose.translation.x()) < 1e-3 * kHalfLength);
  }
}

TEST_CASE("capsules that meet keep momentum and angular momentum and gain no energy") {
  core::Random random(3, 0);
  for (int round = 0; round < 30; ++round) {
    test::Scene scene;
    for (const double side : {-1.0, 1.0}) {
      auto& capsule = add_flying(scene, side, 0.0, 10.0, random);
      capsule.velocity = Vec3(-2.0 * side, 0, 0);
      capsule.restitution = round % 3 == 0 ? 1.0 : 0.5;
      capsule.friction = round % 2 == 0 ? 0.0 : 0.6;
    }
    const double energy = scene.kinetic();
    const Vec3 momentum = scene.momentum(), spin = scene.spin();
    double most = 0.0;
    int rounds = 0;  // in which ends were moved: turned where they are, bodies have another spin
    for (int i = 0; i < 60; ++i) {
      scene.step();
      rounds += scene.report.rounds;
      CHECK(scene.report.failsafe_steps == 0);
      most = std::max(most, scene.kinetic());
    }
    INFO("round " << round);
    CHECK(most <= energy * (1.0 + 1e-9));
    CHECK((scene.momentum() - momentum).norm() < 1e-12 * 2.0 * scene.bodies[0].shape->mass);
    const double measure = spin.norm() + scene.bodies[0].shape->mass * kHalfLength;
    CHECK((scene.spin() - spin).norm() < (rounds == 0 ? 1e-9 : 1e-2) * measure);
  }
}

TEST_CASE("capsules that turn fast do not come into each other") {
  core::Random random(5, 0);
  double deepest = 0.0;
  for (long round = 0; round < test::how_many(150, 20); ++round) {
    test::Scene scene;
    for (const double side : {-1.0, 1.0}) {
      auto& capsule = add_flying(scene, side, 20.0, 115.0, random);
      capsule.velocity = Vec3(-side * random.uniform(1.0, 12.0), 0, 0) + random_direction(random);
    }
    for (int i = 0; i < 20; ++i) {
      scene.step();
      deepest = std::min(deepest, gap_between(scene.bodies[0], scene.bodies[1]));
    }
  }
  CHECK(deepest > -1e-7);
}

TEST_CASE("nothing gets into or through capsules in a heap of everything") {
  core::Random random(7, 0);
  test::Scene scene;
  scene.add(test::make_plane());
  const long count = test::how_many(36, 12);
  for (long i = 0; i < count; ++i) {
    const Vec3 place(0.25 * static_cast<double>(i % 3 - 1), 0.3 + 0.12 * static_cast<double>(i),
                     0.2 * static_cast<double>(i % 2));
    body::Body made = i % 6 == 4   ? test::make_box(Vec3(0.05, 0.08, 0.06), place)
                      : i % 6 == 5 ? test::make_sphere(0.06, place)
                      : i % 6 == 2 ? test::make_shell(test::bowl_mesh(0.1, 4, 12))
                                   : make_capsule(place);
    made.pose = {lying(random_direction(random)), place};
    made.velocity = Vec3(0, -random.uniform(0.0, 20.0), 0);
    made.friction = 0.5;
    scene.add(made);
  }
  scene.settings.has_ways = true;
  audit::Audit audit;
  double frozen = 0.0;
  const int steps = 240;
  for (int i = 0; i < steps; ++i) {
    audit.begin_step(scene.bodies);
    scene.step();
    audit.end_step(scene.bodies, {}, scene.report.ways, (i + 1) * scene.settings.time_step);
    frozen += scene.report.frozen_share / steps;
  }
  CHECK(audit.report().crossings == 0);
  CHECK(audit.report().passages == 0);
  CHECK(frozen < 0.01);
}

}  // namespace shatterbox
