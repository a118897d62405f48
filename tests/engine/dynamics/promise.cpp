// The promise: no pair crosses that did not cross at its start, and none is cut short for more than a few
// steps.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/engine/dynamics/piles.h"

namespace shatterbox {

TEST_CASE("nothing crosses while a sphere comes apart on the floor") {
  auto scene = test::shattered_scene(24, 4.4, 4e-6, 0.006);
  REQUIRE(test::count_crossings(scene) == 0);
  double frozen = 0.0;
  constexpr int kSteps = 48;
  for (int i = 0; i < kSteps; ++i) {
    scene.step();
    INFO("step " << i);
    CHECK(test::count_crossings(scene) == 0);
    CHECK(scene.report.least_gap > 0.0);
    CHECK(scene.report.longest_cut <= 3);
    CHECK(scene.report.crossing_pairs == 0);
    frozen += scene.report.frozen_share / kSteps;
  }
  CHECK(frozen < 0.01);
}

TEST_CASE("boats that fall on each other do not cross") {
  auto scene = test::boats_scene(8);
  const double start = scene.energy();
  for (int i = 0; i < 120; ++i) {
    scene.step();
    INFO("step " << i);
    CHECK(scene.report.least_gap > 0.0);
    CHECK(scene.report.longest_cut <= 3);
    CHECK(scene.energy() <= start * (1.0 + 1e-9));
    if (i % 3 == 0) CHECK(test::count_crossings(scene) == 0);
  }
}

TEST_CASE("only pairs that cross when they are first seen may pass, and they are named") {
  test::Scene scene;
  scene.settings.gravity.setZero();
  auto upright = test::square_mesh(0.1, 3);
  for (Vec3& p : upright.positions) p = Vec3(p.x() + 0.013, p.z() + 0.007, 0.011);
  scene.add(test::make_shell(test::square_mesh(0.1, 3), false));
  scene.add(test::make_shell(upright)).velocity.y() = 1.0;
  auto above = test::make_shell(test::square_mesh(0.1, 2));
  above.pose.translation.y() = 0.3;
  scene.add(above);
  scene.step();
  REQUIRE(scene.report.new_crossing_pairs.size() == 1);
  CHECK(scene.report.new_crossing_pairs[0] == std::pair<body::BodyId, body::BodyId>(1, 2));
  for (int i = 0; i < 60; ++i) {
    scene.step();
    CHECK(scene.report.new_crossing_pairs.empty());
  }
  CHECK(scene.report.crossing_pairs == 0);
  CHECK(scene.bodies[1].pose.translation.y() > 0.1);  // it has come out
  std::vector<geometry::TriangleMesh> meshes;
  for (const std::size_t k : {1, 2}) {
    meshes.push_back(scene.bodies[k].shape->surface);
    for (Vec3& p : meshes.back().positions) p = scene.bodies[k].pose.apply(p);
  }
  CHECK(geometry::count_crossing_pairs(meshes) == 0);  // and has met the other
}

TEST_CASE("what touches exactly falls away freely, and rests where it lies") {
  test::Scene scene;
  scene.add(test::make_box(Vec3(0.2, 0.1, 0.2), Vec3(0, 1, 0), false));
  scene.add(test::make_box(Vec3::Constant(0.1), Vec3(0.05, 0.8, 0)));  // hangs under it
  scene.add(test::make_box(Vec3::Constant(0.1), Vec3(0.05, 1.2, 0)));  // lies on it
  auto plate = test::square_mesh(0.3, 3);
  for (Vec3& p : plate.positions) p.x() += 2.0;
  scene.add(test::make_shell(plate, false));
  auto bowl = test::bowl_mesh(0.1, 4, 12);
  for (Vec3& p : bowl.positions) p += Vec3(2.03, 0.1, 0.02);  // its lowest vertex is on the plate
  scene.add(test::make_shell(bowl));
  for (int i = 0; i < 96; ++i) {
    scene.step();
    CHECK(scene.report.failsafe_steps == 0);
    CHECK(scene.report.crossing_pairs == 0);
  }
  CHECK(0.8 - scene.bodies[1].pose.translation.y() == Approx(0.5 * 9.81 * 0.16).epsilon(1e-3));
  CHECK(scene.bodies[2].pose.translation.y() == Approx(1.2).margin(2e-4));
  for (const Vec3& p : scene.bodies[4].shape->surface.positions)
    CHECK(scene.bodies[4].pose.apply(p).y() > 0.0);
}

TEST_CASE("a plate that turns several radians a step meets what is in its way") {
  test::Scene scene;
  scene.settings.gravity.setZero();
  auto& plate = scene.add(test::make_shell(test::square_mesh(0.05, 2)));
  plate.angular_velocity = Vec3(0, 0, 800.0);  // 3.3 rad a step
  auto post = test::square_mesh(0.01, 1);
  for (Vec3& p : post.positions) p += Vec3(0.012, 0.04, 0);
  scene.add(test::make_shell(post, false));
  const double before = scene.kinetic();
  scene.step();
  CHECK(test::count_crossings(scene) == 0);
  CHECK(scene.kinetic() < before * (1.0 + 1e-9));
  CHECK(scene.bodies[0].angular_velocity.z() < 700.0);
}

TEST_CASE("who is woken in the midst of a step has stood still until then") {
  test::Scene scene;
  scene.settings.has_ways = true;
  scene.settings.gravity.setZero();
  scene.add(test::make_shell(test::square_mesh(0.05, 1))).is_awake = false;
  scene.add(test::make_shell(test::square_mesh(0.05, 1))).velocity = Vec3(0, 1, 0);
  scene.bodies[1].pose.translation.x() = 1.0;
  dynamics::ContactReport step;
  for (int k = 0; k < 4; ++k) {
    if (k == 2) {
      scene.bodies[0].is_awake = true;
      scene.bodies[0].velocity = Vec3(0, 2, 0);
    }
    dynamics::add_part(
        {k, 4}, dynamics::move_part(scene.bodies, scene.settings, {k, 4}, scene.state, scene.log), step);
  }
  REQUIRE(step.ways.size() == 2);
  const auto check_way = [&](std::size_t i, const std::vector<double>& times, double speed, double from) {
    REQUIRE(step.ways[i].points.size() == times.size());
    for (std::size_t k = 0; k < times.size(); ++k) {
      const auto& point = step.ways[i].points[k];
      CHECK(point.time == times[k]);
      CHECK(point.pose.translation.y() == Approx(speed * (point.time - from) / 240.0).margin(1e-15));
    }
  };
  check_way(0, {0.5, 0.75}, 2.0, 0.5);
  check_way(1, {0.25, 0.5, 0.75}, 1.0, 0.0);
}

TEST_CASE("what was let go only a little of a far turn is not taken for one that goes straight") {
  // A stick goes straight from knot to knot; its tip is 2 mm beyond the line from its start to its end.
  test::Scene scene;
  scene.settings.gravity.setZero();
  scene.settings.time_step = 1.0 / 60.0;
  constexpr double kReach = 0.07;
  auto stick = test::square_mesh(kReach, 1), bead = test::square_mesh(1e-4, 1);
  for (Vec3& p : stick.positions) p.z() *= 0.01;
  constexpr double kHalfWay = 0.24;  // rad, of the two fifths of its turn that it is let go
  body::Body& turning = scene.add(test::make_shell(stick));
  turning.pose.rotation = dynamics::rotation_by(Vec3(0, 0, -kHalfWay));
  turning.angular_velocity = Vec3(0, 0, 60.0 * 5.0 * kHalfWay);
  scene.add(test::make_shell(bead)).pose.translation = Vec3(kReach * core::cos(kHalfWay) + 1e-3, 0, 0);
  dynamics::MotionWork work;
  scene.fly(work);
  REQUIRE(work.bodies[0].straight_parts > 1);
  dynamics::shorten(work.bodies[0], 0.4);
  REQUIRE(work.bodies[0].turn_angle < dynamics::kStraightTurn);
  work.bodies[1].end = work.bodies[1].start;
  for (auto& b : work.bodies) dynamics::place_in_boxes(b);
  const auto &a = work.bodies[0], &b = work.bodies[1];
  CHECK(dynamics::clearance_of_balls(a, a.end, b, b.end, 1e-4) <= 1e-4);
  // Further off it is told by how much: the bead from the ball that the stick is in, on its way.
  for (Pose* pose : {&work.bodies[1].start, &work.bodies[1].end}) pose->translation.x() += 0.5;
  const double apart = dynamics::clearance_of_balls(a, a.end, b, b.end, 1e-4);
  CHECK(apart < (b.start.translation - a.start.translation).norm() - a.reach - b.reach);
  CHECK(apart > 0.49);
}

TEST_CASE("a step in which many were cut goes on in shorter parts, from the part in which they were") {
  dynamics::ContactSettings settings;
  settings.time_step = 1.0 / 60.0;
  dynamics::ContactReport moved;
  moved.near_bodies = 300;
  CHECK(!dynamics::divide_where_cut(settings, {1, 2}, moved));
  moved.failsafe_steps = 5;  // all of those hooked to each other
  CHECK(!dynamics::divide_where_cut(settings, {1, 2}, moved));
  moved.newly_cut = 5;
  const auto finer = dynamics::divide_where_cut(settings, {1, 2}, moved);
  REQUIRE(finer);
  CHECK(finer->number == 4);
  CHECK(finer->count == 8);
  CHECK(dynamics::divide_where_cut(settings, *finer, moved)->count == 16);
  CHECK(dynamics::divide_where_cut(settings, {2, 3}, moved)->number == 8);
  CHECK(!dynamics::divide_where_cut(settings, {9, 16}, moved));
}

TEST_CASE("a step whose parts are too long goes on in shorter ones, from where it is") {
  dynamics::ContactSettings settings;
  settings.time_step = 1.0 / 60.0;
  const auto divided = [&](int number, int count, double longest) {
    const dynamics::StepPart part = dynamics::divide_to(settings, {number, count}, longest);
    return std::pair(part.number, part.count);
  };
  CHECK(divided(0, 1, 1e300) == std::pair(0, 1));
  CHECK(divided(1, 2, 0.01) == std::pair(1, 2));
  CHECK(divided(1, 2, settings.time_step / 7.0) == std::pair(4, 8));
  CHECK(divided(0, 4, settings.time_step / 17.0) == std::pair(0, 20));
  CHECK(divided(1, 4, 1e-12) == std::pair(128, 512));  // and no further
}

TEST_CASE("the share of a step that was cut is that of its time, however it was divided") {
  dynamics::ContactReport half, eighth, step;
  half.frozen_share = 0.1;
  eighth.frozen_share = 0.4;
  dynamics::add_part({0, 2}, dynamics::ContactReport(half), step);
  for (int k = 4; k < 8; ++k) dynamics::add_part({k, 8}, dynamics::ContactReport(eighth), step);
  CHECK(step.frozen_share == Approx(0.25));
}

TEST_CASE(
    "a crowd that spins and collides takes its next step in as many parts as it takes, one that is cut too") {
  test::Scene scene;
  constexpr double kHalf = 0.5, kMore = 0.501;  // rad
  const auto parts_after = [&](int turning_hits, double crowd_turn, int newly_cut = 0, int parts = 1) {
    dynamics::ContactReport step;
    step.near_bodies = 300;
    step.crowd_turn = crowd_turn;
    step.newly_cut = newly_cut;
    step.turning_hits = turning_hits;
    dynamics::end_step(scene.settings, step, parts, scene.state);
    scene.state.bodies.resize(1);  // no world that only begins
    return dynamics::count_parts({}, scene.settings, scene.state);
  };
  CHECK(parts_after(0, 0.0) == 1);
  CHECK(parts_after(300, 0.0) == 1);
  CHECK(parts_after(0, 10.0) == 1);  // who spins and hits nobody is in nobody's way
  CHECK(parts_after(10, kMore) == 1);
  CHECK(parts_after(11, kHalf) == 1);
  CHECK(parts_after(11, kMore) == 2);
  CHECK(parts_after(11, 2.0 * kMore) == 4);
  CHECK(parts_after(11, 100.0) == 4);
  CHECK(parts_after(0, 0.0, 1) == 1);
  CHECK(parts_after(0, 0.0, 2) == 4);
  CHECK(parts_after(0, 0.0, 2, 4) == 4);
  scene.settings.time_step = 1.0 / 960.0;
  CHECK(parts_after(0, 0.0, 2) == 1);
  scene.settings.time_step = 1.0 / 60.0;
  CHECK(parts_after(11, 2.0 * kMore) == 4);
  CHECK(parts_after(11, 100.0) == 16);
  CHECK(parts_after(0, 0.0, 2) == 4);
  CHECK(parts_after(0, 0.0, 2, 2) == 8);
  CHECK(parts_after(0, 0.0, 2, 8) == 16);
}

TEST_CASE("of hits those count for the parts of a step in which somebody turns far") {
  test::Scene scene;
  scene.settings.gravity.setZero();
  for (int k = 0; k < 12; ++k) {
    const double turn = 2.0 * core::kPi * k / 12.0;
    const Vec3 out(core::cos(turn), 0.2 * (k % 3), core::sin(turn));
    body::Body sheet = test::make_shell(test::square_mesh(0.1, 2));
    sheet.pose.translation = 0.4 * out;
    sheet.velocity = -15.0 * out;
    sheet.angular_velocity = (k % 2 == 0 ? 200.0 : 100.0) * Vec3(out.z(), 0.5, -out.x());
    scene.add(sheet);
  }
  int hits = 0, turning = 0, slow = 0;
  for (int step = 0; step < 48; ++step) {
    double fastest = 0.0;
    scene.step();
    for (const auto& b : scene.bodies) fastest = std::max(fastest, b.angular_velocity.norm());
    hits += scene.report.hits;
    turning += scene.report.turning_hits;
    CHECK(scene.report.turning_hits <= scene.report.hits);
    if (fastest * scene.settings.time_step <= dynamics::kStraightTurn) {
      slow += scene.report.hits;
      CHECK(scene.report.turning_hits == 0);
    }
    if (step == 24)
      for (auto& b : scene.bodies) b.angular_velocity *= 0.05;
  }
  WARN(hits << " hits, of " << turning << " that turn, " << slow << " where nobody does");
  CHECK(turning > 0);
  CHECK(slow > 0);
}

TEST_CASE("of those who count for the parts of a step each is near another, spheres do not spin") {
  test::Scene scene;
  scene.settings.time_step = 1.0 / 60.0;
  scene.add(test::make_plane());
  scene.add(test::make_box(Vec3::Constant(0.05), Vec3(0, 0.06, 0)));    // near the plane, and turns
  scene.add(test::make_sphere(0.05, Vec3(1, 0.0501, 0)));               // near it too
  scene.add(test::make_box(Vec3::Constant(0.05), Vec3(3, 20.0, 0)));    // far from all
  scene.add(test::make_box(Vec3::Constant(0.05), Vec3(5, 0.0501, 0)));  // lies still
  for (std::size_t i = 1; i < 4; ++i) scene.bodies[i].angular_velocity = Vec3(0, 60.0, 0);
  scene.step();
  CHECK(scene.report.awake_bodies == 4);
  CHECK(scene.report.near_bodies == 3);
  CHECK(scene.report.crowd_turn == Approx(1.0).epsilon(0.01));
}

TEST_CASE(
    "a step with newborn pieces is taken in at least four parts and none longer than a 960th of a second") {
  test::Scene scene;
  for (int k = 0; k < 3; ++k)
    scene.add(test::make_shell(test::square_mesh(0.05, 1))).pose.translation.x() = 0.2 * k;
  const auto parts_at = [&](double rate, std::size_t known) {
    scene.settings.time_step = 1.0 / rate;
    scene.state.bodies.clear();
    for (std::size_t k = 0; k < known; ++k) scene.state.bodies.push_back({});
    for (std::size_t k = 0; k < known; ++k) scene.state.bodies[k].id = scene.bodies[k].id;
    return dynamics::count_parts(scene.bodies, scene.settings, scene.state);
  };
  CHECK(parts_at(60, 1) == 16);
  CHECK(parts_at(120, 1) == 8);
  CHECK(parts_at(240, 1) == 4);
  CHECK(parts_at(960, 1) == 4);
  CHECK(parts_at(60, 3) == 1);
}

}  // namespace shatterbox
