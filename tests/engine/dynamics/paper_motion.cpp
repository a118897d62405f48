// The scheme of [BHTF07] sec. III: what it keeps (momentum, particles free of crossings) and what it does not
// (rigid surfaces free of crossings, no drift).
#include "engine/dynamics/paper_motion.h"

#include <catch2/catch.hpp>

#include "engine/core/parallel.h"
#include "engine/geometry/crossings.h"
#include "tests/engine/dynamics/bodies.h"

namespace shatterbox {
namespace {

struct PaperScene : test::Scene {
  dynamics::PaperContactState paper;

  void step() {
    log.clear();
    report = dynamics::step_paper_motion(bodies, settings, paper, log);
  }
  /// Crossing pairs of triangles of the drifting surfaces, and of the rigid ones.
  long drifting_crossings() const {
    std::vector<geometry::TriangleMesh> meshes;
    for (std::size_t i = 0; i < bodies.size(); ++i)
      if (bodies[i].shape->kind == body::ShapeKind::shell)
        meshes.push_back({paper.surfaces[i].particles, bodies[i].shape->surface.triangles});
    return geometry::count_crossing_pairs(meshes);
  }
};

PaperScene two_bowls(double speed) {
  PaperScene scene;
  scene.settings.gravity.setZero();
  auto& left = scene.add(test::make_shell(test::bowl_mesh(0.1, 5, 16)));
  left.velocity = Vec3(speed, 0, 0);
  auto& right = scene.add(test::make_shell(test::bowl_mesh(0.1, 5, 16)));
  right.pose.translation += Vec3(0.3, 0.03, 0.02);
  right.velocity = Vec3(-speed, 0, 0);
  right.angular_velocity = Vec3(0, 3, 1);
  return scene;
}

}  // namespace

TEST_CASE("without contact the paper's scheme is free flight: the parabola is exact") {
  PaperScene scene;
  auto& ball = scene.add(test::make_shell(test::bowl_mesh(0.1, 4, 12)));
  ball.velocity = Vec3(1, 3, -2);
  const Vec3 start = ball.pose.translation;
  for (int i = 0; i < 240; ++i) scene.step();
  const Vec3 expected = start + Vec3(1, 3, -2) + 0.5 * scene.settings.gravity;
  CHECK((scene.bodies[0].pose.translation - expected).norm() < 1e-12);
  CHECK(scene.report.drift < 1e-12);
}

TEST_CASE("bowls that meet under the paper's scheme keep momentum, and their particles never cross") {
  for (const double speed : {1.0, 10.0, 100.0}) {
    auto scene = two_bowls(speed);
    const Vec3 momentum = scene.momentum();
    bool has_met = false;
    double most_drift = 0.0;
    for (int i = 0; i < 90; ++i) {
      scene.step();
      has_met = has_met || !scene.log.empty();
      most_drift = std::max(most_drift, scene.report.drift);
      REQUIRE(scene.drifting_crossings() == 0);
      INFO("speed " << speed << " step " << i);
      CHECK((scene.momentum() - momentum).norm() < 1e-12 * (1.0 + speed));
    }
    CHECK(has_met);
    WARN("two bowls at " << speed << " m/s: greatest drift " << most_drift << " m");
  }
}

TEST_CASE("a plate that falls on the ground comes to rest on it under the paper's scheme") {
  PaperScene scene;
  scene.add(test::make_plane());
  auto& plate = scene.add(test::make_shell(test::square_mesh(0.1, 4)));
  plate.pose.translation = Vec3(0, 0.2, 0);
  plate.restitution = 0.0;
  double impulse_at_rest = 0.0;
  for (int i = 0; i < 480; ++i) {
    scene.step();
    REQUIRE(scene.bodies[1].pose.translation.y() > -1e-9);
    if (i < 240) continue;
    for (const auto& entry : scene.log) impulse_at_rest += entry.impulse_world.y();
  }
  CHECK(scene.bodies[1].pose.translation.y() < 1e-3);
  CHECK(scene.bodies[1].velocity.norm() < 0.1);
  CHECK(impulse_at_rest == Approx(scene.bodies[1].shape->mass * 9.81).epsilon(0.02));
}

TEST_CASE("the paper's scheme gives the same bits for any number of threads") {
  std::vector<std::uint64_t> hashes;
  for (const int threads : {1, 2, 4}) {
    core::set_thread_count(threads);
    auto scene = two_bowls(5.0);
    for (int i = 0; i < 60; ++i) scene.step();
    core::Hash hash(scene.hash());
    dynamics::add_to_hash(scene.paper, hash);
    hashes.push_back(hash.value());
  }
  core::set_thread_count(0);
  CHECK(hashes[0] == hashes[1]);
  CHECK(hashes[0] == hashes[2]);
}

}  // namespace shatterbox
