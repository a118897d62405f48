// The failsafe, forced: every tenth step the solver's result is thrown away, all bodies fly on freely, and
// only what cuts their ways short keeps them from crossing.
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "engine/dynamics/motion_work.h"
#include "tests/engine/dynamics/piles.h"
#include "tests/support/sanitized.h"

namespace shatterbox {
namespace {

void step_by_failsafe(test::Scene& scene, bool is_shortest = false) {
  auto settings = scene.settings;
  settings.continuous_rounds = 0;
  scene.log.clear();
  scene.report = {};
  dynamics::MotionWork work;
  dynamics::find_candidate_pairs(scene.bodies, settings, scene.state, work);
  work.is_shortest = is_shortest;
  work.contacts.clear();
  work.islands.clear();
  for (auto& body : work.bodies) body.is_free = true;
  dynamics::solve_motion(scene.bodies, settings, work);
  dynamics::guard_motion(scene.bodies, settings, {}, scene.state, work, scene.report);
  dynamics::finish_motion(scene.bodies, scene.state, work, scene.log, scene.report);
}

struct Outcome {
  int forced = 0, cut = 0, longest = 0, named = 0;  // cut: in forced steps
  double most = 0.0;                                // J
};

Outcome run(test::Scene& scene, int steps) {
  Outcome outcome;
  for (int i = 1; i <= steps; ++i) {
    const bool is_forced = i % 10 == 0;
    if (is_forced) {
      step_by_failsafe(scene);
      ++outcome.forced;
      outcome.cut += scene.report.failsafe_steps;
      CHECK(test::count_crossings(scene) == 0);
    } else {
      scene.step();
    }
    outcome.longest = std::max(outcome.longest, scene.report.longest_cut);
    if (scene.report.longest_cut > 0) {
      const auto& [a, b] = scene.report.longest_cut_pair;
      CHECK(a < b);
      CHECK(body::find_body(scene.bodies, b) != nullptr);
      ++outcome.named;
    }
    outcome.most = std::max(outcome.most, scene.energy());
  }
  CHECK(test::count_crossings(scene) == 0);
  return outcome;
}

}  // namespace

TEST_CASE("what two that go as one come upon, and what that pushes on, gives way to them") {
  test::Scene scene;
  scene.settings.gravity.setZero();
  // The first goes through the second, and both as one through the others that lie close above.
  for (const double height : {0.0, 0.02, 0.032, 0.0325, 0.033}) {
    body::Body sheet = test::make_shell(test::square_mesh(0.1, 2));
    sheet.pose.translation.y() = height;
    if (scene.bodies.empty()) sheet.velocity = Vec3(0, 7.2, 0);
    scene.add(sheet);
  }
  const auto start = scene.bodies;
  step_by_failsafe(scene);
  CHECK(scene.report.failsafe_steps == 2);
  CHECK(test::count_crossings(scene) == 0);
  for (std::size_t i = 0; i < start.size(); ++i)
    CHECK(scene.bodies[i].pose.translation.y() > start[i].pose.translation.y() + 1e-4);
  for (std::size_t i = 1; i < start.size(); ++i)
    CHECK(scene.bodies[i].pose.translation.y() > scene.bodies[i - 1].pose.translation.y());
}

TEST_CASE("who is cut in the shortest parts too is hooked until he goes free, and asks for no shorter ones") {
  test::Scene scene;
  scene.settings.gravity.setZero();
  for (const double height : {0.0, 0.02}) {
    body::Body sheet = test::make_shell(test::square_mesh(0.1, 2));
    sheet.pose.translation.y() = height;
    scene.add(sheet);
  }
  const auto cut_at = [&](double speed, bool is_shortest) {
    scene.bodies[0].velocity = Vec3(0, speed, 0);
    scene.bodies[1].velocity.setZero();
    step_by_failsafe(scene, is_shortest);
    return std::vector{scene.report.failsafe_steps, scene.report.newly_cut};
  };
  CHECK(cut_at(7.2, false) == std::vector{2, 2});
  CHECK(cut_at(7.2, false) == std::vector{2, 2});
  CHECK(cut_at(7.2, true) == std::vector{2, 2});
  CHECK(cut_at(7.2, true) == std::vector{2, 0});
  CHECK(cut_at(7.2, false) == std::vector{2, 0});
  CHECK(cut_at(-7.2, false) == std::vector{0, 0});
  CHECK(cut_at(15.0, true) == std::vector{2, 2});
}

TEST_CASE("free fall does not know of the failsafe until something is hit") {
  int cut = 0;
  for (const double height : test::kIsSanitized ? std::vector{0.54} : std::vector{0.5, 0.52, 0.54}) {
    test::Scene scene;
    scene.settings.has_sleep = false;
    scene.add(test::make_plane());
    for (int k = 0; k < 3; ++k) {
      auto bowl = test::make_shell(test::bowl_mesh(0.1, 4, 12, -0.2));
      bowl.pose.translation =
          Vec3(0.01 * k, height + 0.05 * k, 0);  // each in the one below, and none touches
      scene.add(bowl);
    }
    const auto start = scene.bodies;
    const double energy = scene.energy();
    const auto falling = run(scene, 60);
    CHECK(falling.cut == 0);
    for (std::size_t k = 1; k < 4; ++k) {
      const double fallen = start[k].pose.translation.y() - scene.bodies[k].pose.translation.y();
      CHECK(fallen == Approx(0.5 * 9.81 * 0.0625).epsilon(1e-12));
    }
    const auto landing = run(scene, 900);
    WARN("three bowls: " << landing.cut << " body-steps cut in " << landing.forced
                         << " forced steps, longest " << landing.longest << ", fastest at the end "
                         << scene.bodies[3].velocity.norm());
    cut += landing.cut;
    CHECK(landing.longest <= 3);
    CHECK(landing.most <= energy * (1.0 + 1e-9));
    CHECK(scene.kinetic() < 1e-3);  // of 0.5 kg
    for (std::size_t k = 1; k < 4; ++k) CHECK(scene.bodies[k].pose.translation.y() < 0.2);
  }
  CHECK(cut > 3);
}

TEST_CASE("a pile whose solver fails every tenth step comes to rest where others do, and gains nothing") {
  auto scene = test::boats_scene(static_cast<int>(test::how_many(8, 3)), 1, 1.0 / 120.0);
  auto twin = scene;
  const double energy = scene.energy();
  const int steps = static_cast<int>(test::how_many(360, 120));
  const auto outcome = run(scene, steps);
  for (int i = 0; i < steps; ++i) twin.step();
  const auto height = [](const test::Scene& s) {
    double sum = 0.0;
    for (const auto& b : s.bodies) sum += b.is_dynamic() ? b.pose.translation.y() : 0.0;
    return sum;
  };
  WARN("boats: " << outcome.cut << " body-steps cut in " << outcome.forced << " forced steps, longest "
                 << outcome.longest << ", kinetic energy " << scene.kinetic() << " J against "
                 << twin.kinetic() << ", mean height ratio " << height(scene) / height(twin));
  CHECK(outcome.cut > (test::kIsSanitized ? 3 : 10));
  CHECK(outcome.longest <= 3);
  CHECK(outcome.named > 0);
  CHECK(outcome.most <= energy * (1.0 + 1e-9));
  CHECK(height(scene) == Approx(height(twin)).epsilon(0.2));
  // Nothing hangs: with the failsafe gone it goes on as any pile.
  for (int i = 0; i < 120; ++i) scene.step();
  CHECK(scene.report.longest_cut <= 3);
  CHECK(scene.energy() <= energy);
}

}  // namespace shatterbox
