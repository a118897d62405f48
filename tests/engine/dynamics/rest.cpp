// Sleep and waking: who keeps whom awake, and what a disturbance reaches.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/engine/dynamics/bodies.h"
#include "tests/engine/dynamics/piles.h"

namespace shatterbox {
namespace {

constexpr double kHalfSide = 0.1;  // m

// A row of boxes side by side on the ground, and time for all to fall asleep.
test::Scene sleeping_row(const std::vector<double>& densities, double friction = 0.5, double gap = 1e-4,
                         bool are_solids = false) {
  test::Scene scene;
  scene.settings.overrides = {{0, 0, friction, 0.0}};
  scene.add(test::make_plane());
  double x = 0.0;
  for (const double density : densities) {
    const Vec3 half = Vec3::Constant(kHalfSide), place(x, kHalfSide + 5e-5, 0);
    scene.add(are_solids ? test::make_solid_block(half, place, density)
                         : test::make_box(half, place, true, density));
    x += 2.0 * kHalfSide + gap;
  }
  for (int i = 0; i < 300; ++i) scene.step();
  for (std::size_t k = 1; k < scene.bodies.size(); ++k) {
    INFO("box " << k);
    REQUIRE(!scene.bodies[k].is_awake);
  }
  return scene;
}

// Pushes a body to and fro, noticeably, for two seconds.
void shake(test::Scene& scene, std::size_t number, double speed) {
  for (int i = 0; i < 480; ++i) {
    body::Body& b = scene.bodies[number];
    b.is_awake = true;
    b.velocity = Vec3(i % 2 == 0 ? speed : -speed, 0, 0);
    scene.step();
  }
}

}  // namespace

TEST_CASE("a body that trembles keeps its neighbours awake, and nobody else") {
  auto scene = sleeping_row({1000, 1000, 1000, 1000, 1000});
  for (body::Body& b : scene.bodies) b.is_awake = true;
  shake(scene, 1, 0.05);
  CHECK(scene.bodies[2].is_awake);
  for (std::size_t k = 3; k < 6; ++k) CHECK(!scene.bodies[k].is_awake);
}

TEST_CASE("a feeble one does not keep a heavy one awake") {
  auto scene = sleeping_row({1, 1000});
  for (body::Body& b : scene.bodies) b.is_awake = true;
  shake(scene, 1, 0.02);
  CHECK(!scene.bodies[2].is_awake);
}

TEST_CASE("a blow wakes the row to its end, and its momentum goes through") {
  auto scene = sleeping_row({1000, 1000, 1000, 1000}, 0.0);
  auto ball = test::make_sphere(kHalfSide, Vec3(-3.0 * kHalfSide, kHalfSide + 1e-4, 0), 5000.0);
  ball.velocity = Vec3(5, 0, 0);
  const double momentum = ball.shape->mass * 5.0;
  scene.add(std::move(ball));
  bool all_awake = false;
  for (int i = 0; i < 24; ++i) {
    scene.step();
    int awake = 0;
    for (std::size_t k = 1; k < 5; ++k) awake += scene.bodies[k].is_awake ? 1 : 0;
    CHECK((awake == 0 || awake == 4));
    all_awake = all_awake || awake == 4;
  }
  CHECK(all_awake);
  CHECK(scene.momentum().x() == Approx(momentum).epsilon(1e-9));
  CHECK(scene.bodies[4].velocity.x() > 1.0);
}

TEST_CASE("what is hit in its sleep passes it on to those who sleep beside it, however near") {
  for (const bool are_solids : {false, true})
    for (const double gap : {2e-4, 5e-4, 1e-3, 2e-3, 4e-3, 1e-2, 2e-2})
      for (const double speed : {0.2, 5.0}) {
        INFO("gap " << gap << " m, " << speed << " m/s, " << (are_solids ? "solids" : "boxes"));
        auto scene = sleeping_row({1000, 1000, 1000}, 0.0, gap, are_solids);
        scene.add(test::make_box(Vec3::Constant(kHalfSide), Vec3(-0.3, kHalfSide + 5e-5, 0), true, 10000));
        scene.bodies.back().velocity = Vec3(speed, 0, 0);
        const double before = scene.momentum().x();
        // Until all four have met.
        const int steps = static_cast<int>((0.2 + 4.0 * gap) / speed * 240.0) + 10;
        for (int i = 0; i < steps; ++i) scene.step();
        CHECK(scene.momentum().x() == Approx(before).epsilon(1e-9));
        for (std::size_t k = 1; k < scene.bodies.size(); ++k)
          CHECK(scene.bodies[k].velocity.x() > 0.5 * speed);
      }
}

TEST_CASE("a light blow on a crowd that sleeps wakes as many as it could move, not all") {
  std::vector<double> densities(61, 1000.0);
  densities.back() = 100.0;
  auto scene = sleeping_row(densities);
  scene.bodies.back().is_awake = true;
  scene.bodies.back().velocity = Vec3(-0.3, 0, 0);
  int most = 0;
  for (int i = 0; i < 24; ++i) {
    scene.step();
    int awake = 0;
    for (std::size_t k = 1; k + 1 < scene.bodies.size(); ++k) awake += scene.bodies[k].is_awake ? 1 : 0;
    most = std::max(most, awake);
  }
  CHECK(most >= 1);
  CHECK(most <= 20);
}

TEST_CASE("who is not woken in a step meets as he met before another was, to the same bits") {
  const auto run = [](bool has_caches) {
    auto scene = test::boats_scene(24, 3);
    scene.settings.has_caches = has_caches;
    for (int i = 0; i < 90; ++i) scene.step();
    int woken = 0;
    for (int i = 0; i < 40; ++i) {
      // Every other one that lies there is asleep, whatever it thinks of it.
      for (std::size_t k = 1; i % 4 == 0 && k < scene.bodies.size(); k += 2) {
        body::Body& b = scene.bodies[k];
        b.velocity.setZero();
        b.angular_velocity.setZero();
        b.is_awake = b.is_awake && !b.is_dynamic();
      }
      const auto before = scene.bodies;
      scene.step();
      for (std::size_t k = 0; k < before.size(); ++k)
        woken += before[k].sleeps() && !scene.bodies[k].sleeps() ? 1 : 0;
    }
    return std::pair(scene.hash(), woken);
  };
  const auto expected = run(false);
  CHECK(expected.second > 20);
  CHECK(run(true) == expected);
}

TEST_CASE("what something bears is looked for where it lies, and falls once nothing does") {
  for (const bool has_more_below : {false, true}) {
    test::Scene scene;
    scene.settings.has_sleep = false;
    const double dt = scene.settings.time_step = 1.0 / 60.0;
    const double fall = 0.5 * dt * dt * scene.settings.gravity.norm();
    auto below = test::square_mesh(0.1, 4);
    for (Vec3& p : below.positions) p.y() -= 0.7 * fall;
    auto above = test::square_mesh(0.01, 2);
    for (Vec3& p : above.positions) p.y() += 1e-4;
    if (has_more_below) scene.add(test::make_shell(below, false));
    const auto plate = static_cast<std::size_t>(&scene.add(test::make_shell(above)) - scene.bodies.data());
    scene.add(test::make_shell(test::square_mesh(0.1, 4), false));
    for (int i = 0; i < 12; ++i) scene.step();
    auto state = scene.state;
    dynamics::MotionWork work;
    dynamics::find_candidate_pairs(scene.bodies, scene.settings, state, work);
    const auto lies = std::find_if(work.pairs.begin(), work.pairs.end(),
                                   [](const auto& pair) { return !pair.contacts.empty(); });
    REQUIRE(lies != work.pairs.end());
    REQUIRE(fall > scene.settings.search_slack * lies->size);
    CHECK_FALSE(lies->is_fast);

    scene.bodies.pop_back();
    const Vec3 start = scene.bodies[plate].pose.translation, velocity = scene.bodies[plate].velocity;
    scene.step();
    CHECK(test::count_crossings(scene) == 0);
    const body::Body& end = scene.bodies[plate];
    if (has_more_below) {
      CHECK(scene.report.hits > 0);
      continue;
    }
    CHECK((end.pose.translation - start - dt * velocity - Vec3(0, -fall, 0)).norm() < 1e-15);
    CHECK((end.velocity - velocity - dt * scene.settings.gravity).norm() < 1e-15);
  }
}

TEST_CASE("who sleeps on something falls when it has slipped away") {
  // A light slab under a heavy box, pulled out too feebly to disturb the box, until it has gone.
  test::Scene scene;
  scene.settings.overrides = {{0, 0, 0.0, 0.0}};
  scene.add(test::make_plane());
  scene.add(test::make_box(Vec3(kHalfSide, 0.01, kHalfSide), Vec3(0, 0.01, 0), true, 1.0));
  scene.add(test::make_box(Vec3::Constant(kHalfSide), Vec3(0, 0.02 + kHalfSide, 0), true, 1000.0));
  for (int i = 0; i < 300; ++i) scene.step();
  REQUIRE(!scene.bodies[2].is_awake);
  int hanging = 0;
  for (int i = 0; i < 480 && scene.bodies[2].pose.translation.y() > kHalfSide + 2e-3; ++i) {
    if (scene.bodies[1].pose.translation.x() < 2.5 * kHalfSide) {
      scene.bodies[1].is_awake = true;
      scene.bodies[1].velocity = Vec3(0.3, 0, 0);
    } else {
      ++hanging;
    }
    scene.step();
  }
  CHECK(hanging <= 60);
  CHECK(scene.bodies[2].pose.translation.y() < kHalfSide + 2e-3);
}

TEST_CASE("what lies still sleeps after the time that a thing of its size takes to fall, or half a second") {
  // Seconds until a cube of this size (m, across its corners) sleeps.
  const auto time_to_sleep = [](double size) {
    test::Scene scene;
    scene.add(test::make_plane());
    const double half = 0.5 * size / std::sqrt(3.0);
    scene.add(test::make_box(Vec3::Constant(half), Vec3(0, half * (1.0 + 1e-3), 0)));
    double time = 0.0;
    for (; scene.bodies[1].is_awake && time < 5.0; time += scene.settings.time_step) scene.step();
    return time;
  };
  const auto fall = [](double size) { return 1.57 * std::sqrt(size / 9.81); };
  const double late = 0.05;  // until it lies, and to the next step
  for (const auto& [size, expected] :
       {std::pair(0.01, 4.0 * fall(0.01)), {0.03, 4.0 * fall(0.03)}, {0.3, 0.5}, {4.0, fall(4.0)}}) {
    const double time = time_to_sleep(size);
    INFO(size << " m: " << time << " s, expected " << expected);
    CHECK(time >= expected - 1e-9);
    CHECK(time < expected + late);
  }
}

TEST_CASE("a tower that begins to tip is not at rest, whatever its size") {
  for (const double height : {0.2, 2.0, 20.0, 100.0}) {
    test::Scene scene;
    scene.add(test::make_plane());
    const Vec3 half(0.1 * height, 0.5 * height, 0.1 * height);
    body::Body tower = test::make_box(half, Vec3::Zero());
    // One degree past where its centre is above the edge.
    const double lean = std::atan2(half.x(), half.y()) + 0.0175;
    tower.pose.rotation = Quat(Eigen::AngleAxisd(-lean, Vec3::UnitZ()));
    const Vec3 edge = tower.pose.rotation * Vec3(half.x(), -half.y(), 0.0);
    tower.pose.translation.y() = 1e-5 * height - edge.y();
    scene.add(tower);
    const double begin = tower.pose.translation.y();
    const int steps = static_cast<int>(240 * 4.0 * std::max(1.0, std::sqrt(height)));
    for (int i = 0; i < steps && scene.bodies[1].pose.translation.y() > 0.5 * begin; ++i) scene.step();
    INFO(height << " m");
    CHECK(scene.bodies[1].pose.translation.y() < 0.5 * begin);
  }
}

}  // namespace shatterbox
