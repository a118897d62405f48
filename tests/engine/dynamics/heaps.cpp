// What hits a heap: an island that is too large to be solved anew for every hit.
#include <catch2/catch.hpp>

#include "tests/engine/dynamics/bodies.h"

namespace shatterbox {
namespace {

constexpr int kTowerSheets = 240;
constexpr double kTowerSide = 1.0, kTowerGap = 1e-3;  // m
constexpr double kTowerBall = 0.05;                   // m

/// Without gravity: a tower of sheets that nearly touch, over it a ball at rest, and over that one that comes
/// down at `speed` (m/s) so that only the hit on the first sends that on its way to the sheets. Balls are
/// elastic, and have the sheets' restitution with these. The first is so far (m) over the tower, the second
/// so far over it.
test::Scene tower_scene(double speed, double restitution, double over_tower = 3e-3, double apart = 1e-3) {
  test::Scene scene;
  scene.settings.gravity.setZero();
  scene.settings.time_step = 1.0 / 60.0;
  const auto sheet = test::make_shell(test::square_mesh(0.5 * kTowerSide, 2));
  for (int i = 0; i < kTowerSheets; ++i) {
    auto next = sheet;
    next.pose.translation.y() = kTowerGap * (i - kTowerSheets);
    next.restitution = restitution;
    scene.add(next);
  }
  // Not over a corner: there a ball meets several features at once.
  const Vec3 over(0.17, 0.0, 0.05);
  for (const double height :
       {kTowerBall - kTowerGap + over_tower, 3.0 * kTowerBall - kTowerGap + over_tower + apart})
    scene.add(test::make_sphere(kTowerBall, over + Vec3(0.0, height, 0.0), 50.0)).restitution = 1.0;
  scene.bodies.back().velocity.y() = -speed;
  return scene;
}

double mass_of(const body::Body& b, const Vec3& arm) {
  const Vec3 moment = arm.cross(Vec3::UnitY());
  return 1.0 / (b.inverse_mass + moment.dot(b.inverse_inertia_world() * moment));
}

}  // namespace

TEST_CASE("what hits a large heap bounces off it as off any other body") {
  for (const double restitution : {0.0, 0.5, 1.0}) {
    constexpr double kSpeed = 0.6;
    test::Scene scene = tower_scene(kSpeed, restitution);
    const Vec3 before = scene.momentum();
    const double energy = scene.kinetic();
    const body::Body top = scene.bodies[kTowerSheets - 1];
    scene.step();
    CHECK(scene.report.solver_contacts > static_cast<int>(dynamics::Island::kLarge));
    CHECK(scene.report.hits > 0);
    // The balls are alike: the second has the speed of the first, until it meets the sheet.
    const Vec3 arm = scene.bodies[kTowerSheets].pose.translation - top.pose.translation;
    const double m = mass_of(scene.bodies[kTowerSheets], Vec3::Zero()),
                 sheet = mass_of(top, Vec3(arm.x(), 0, arm.z()));
    const double change = (1.0 + restitution) * kSpeed * sheet / (m + sheet);
    CHECK(scene.bodies[kTowerSheets].velocity.y() == Approx(change - kSpeed).margin(1e-3 * kSpeed));
    CHECK((scene.momentum() - before).norm() < 1e-12);
    CHECK(scene.kinetic() <= energy * (1.0 + 1e-12));
  }
}

TEST_CASE("what comes slowly upon a heap that may break is opened, and nobody solved anew for it") {
  // Of the last the first is struck so late in the step that it goes but 3 mm.
  for (const double speed : {0.3, 0.6, 20.0}) {
    // All fall alike, and what closes no faster than they fall in two steps does not bounce.
    test::Scene scene = tower_scene(speed, 0.5, 1.5e-3, speed < 1.0 ? 1e-3 : 0.99 * speed / 60.0);
    scene.settings.gravity = Vec3(0.0, -9.81, 0.0);
    for (int i = 0; i < kTowerSheets; ++i) scene.bodies[static_cast<std::size_t>(i)].may_break = true;
    const Vec3 before = scene.momentum();
    double mass = 0.0;
    for (const body::Body& b : scene.bodies) mass += b.shape->mass;
    scene.step();
    CHECK(scene.report.solver_contacts > static_cast<int>(dynamics::Island::kLarge));
    CHECK(scene.report.hits > 0);
    CHECK((scene.report.rounds > 0) == (speed < 0.39));
    const Vec3 fall = mass * scene.settings.time_step * scene.settings.gravity;
    CHECK((scene.momentum() - before - fall).norm() < 1e-12 * mass);
  }
}

TEST_CASE("a heap that is solved anew has the same bits whether or not something far away may break") {
  // So deep that it is.
  test::Scene plain = tower_scene(20.0, 0.3), fragile = tower_scene(20.0, 0.3);
  const auto far = test::make_box(Vec3::Constant(0.5), Vec3(100.0, 0.0, 0.0));
  plain.add(far);
  fragile.add(far).may_break = true;
  for (int i = 0; i < 3; ++i) {
    plain.step();
    fragile.step();
    CHECK(plain.report.solver_contacts > static_cast<int>(dynamics::Island::kLarge));
    CHECK(plain.hash() == fragile.hash());
  }
}

}  // namespace shatterbox
