// Energy: a closed box of shells and solids never has more than it began with, and what falls and rubs only
// loses.
#include <catch2/catch.hpp>
#include <cmath>
#include <optional>

#include "tests/engine/dynamics/piles.h"
#include "tests/support/sanitized.h"

namespace shatterbox {
namespace {

const Vec3 kMiddle(0, 0.5, 0);

/// The half space behind a wall that looks along `normal`, half a metre from the middle of the room.
void add_wall(test::Scene& scene, const Vec3& normal) {
  auto wall = test::make_plane();
  wall.pose.rotation = Quat::FromTwoVectors(Vec3::UnitY(), normal);
  wall.pose.translation = kMiddle - 0.5 * normal;
  scene.add(wall);
}

/// Shells and solids that fly about in a closed room of a metre, as large as a quarter of it.
test::Scene room_scene(std::uint64_t seed, double restitution) {
  test::Scene scene;
  scene.settings.gravity.setZero();
  scene.settings.has_sleep = false;
  for (const int axis : {1, 0, 2}) {  // the floor comes first
    add_wall(scene, Vec3::Unit(axis));
    add_wall(scene, -Vec3::Unit(axis));
  }
  core::Random random(seed);
  const auto draw = [&] {
    Vec3 v;
    for (int i = 0; i < 3; ++i) v[i] = random.uniform(-1, 1);
    return v;
  };
  const auto bowl = test::make_shell(test::bowl_mesh(0.1, 4, 10));
  const auto plate = test::make_shell(test::square_mesh(0.09, 2));
  for (int i = 0; i < 8; ++i) {
    auto body = i < 3   ? bowl
                : i < 5 ? plate
                : i < 7 ? test::make_box(Vec3(0.05, 0.07, 0.09), Vec3::Zero(), true, 300.0 * i)
                        : test::make_sphere(0.09, Vec3::Zero());
    body.pose.translation =
        kMiddle + 0.25 * Vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1) + 0.02 * draw();
    body.pose.rotation = test::random_rotation(random);
    body.velocity = 2.0 * draw();
    body.angular_velocity = 5.0 * draw();
    scene.add(body);
  }
  for (auto& body : scene.bodies) {
    body.friction = 0.0;
    body.restitution = restitution;
  }
  return scene;
}

/// `least_collisions`: steps with impulses, at least, or the room was not alive. Returns the share of the
/// energy that is left.
double check_room(double restitution, long steps, long least_collisions) {
  auto scene = room_scene(3, restitution);
  const double start = scene.kinetic();
  double most = 0.0, rise = 0.0, last = start;
  long collisions = 0, hits = 0, cut = 0;
  for (long i = 0; i < steps; ++i) {
    scene.step();
    const double now = scene.kinetic();
    most = std::max(most, now);
    rise = std::max(rise, now - last);
    last = now;
    collisions += scene.log.empty() ? 0 : 1;
    hits += scene.report.hits;
    cut += scene.report.failsafe_steps;
    if (i % 100 == 0) REQUIRE(test::count_crossings(scene) == 0);
  }
  WARN("room, restitution " << restitution << ", " << steps << " steps: most / start - 1 "
                            << most / start - 1.0 << ", greatest rise in a step " << rise / start << ", kept "
                            << last / start << ", steps with impulses " << collisions << ", hits " << hits
                            << ", cut " << cut);
  CHECK(most <= start * (1.0 + 1e-9));
  CHECK(collisions > least_collisions);
  CHECK(scene.report.crossing_pairs == 0);
  return last / start;
}

double least_squares_slope(const std::vector<double>& values) {
  const double n = static_cast<double>(values.size()), middle = 0.5 * (n - 1.0);
  double up = 0.0, down = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    up += (static_cast<double>(i) - middle) * values[i];
    down += (static_cast<double>(i) - middle) * (static_cast<double>(i) - middle);
  }
  return up / down;
}

// What falls, rubs and settles on the floor of the room.
void check_settling(int seconds) {
  auto scene = room_scene(5, 0.4);
  scene.settings.gravity = Vec3(0, -9.81, 0);
  for (auto& body : scene.bodies) body.friction = 0.5;
  const double start = scene.energy();
  double most = start, rise = 0.0;
  int cut = 0;
  std::vector<double> shares;
  for (int i = 0; i < 240 * seconds; ++i) {
    const double before = scene.energy();
    scene.step();
    most = std::max(most, scene.energy());
    rise = std::max(rise, scene.energy() - before);
    cut += scene.report.failsafe_steps;
    if (i >= 240 * seconds / 2) shares.push_back(scene.energy() / start);
  }
  WARN("room with gravity and friction, "
       << seconds << " s: most / start - 1 " << most / start - 1.0 << ", greatest rise in a step "
       << rise / start << ", slope of the later half " << 240.0 * least_squares_slope(shares) << " 1/s, kept "
       << shares.back() << ", cut " << cut);
  CHECK(most <= start * (1.0 + 1e-3));
  CHECK(rise <= 1e-3 * start);
  CHECK(test::count_crossings(scene) == 0);
}

// Thin ones most of all: a spin that is nearly along one is a thousand times the same across it.
body::Body make_tumbling(int kind) {
  constexpr double kHalfWay = 0.07;
  if (kind == 0) return test::make_capsule(0.005, kHalfWay, Vec3::Zero());
  if (kind == 1) return test::make_box(Vec3(kHalfWay, 0.004, 0.006), Vec3::Zero());
  if (kind == 2) return test::make_box(Vec3::Constant(0.05), Vec3::Zero());
  auto mesh = test::square_mesh(kHalfWay, 2);
  if (kind == 3)
    for (Vec3& p : mesh.positions) p.z() *= 0.1;
  return test::make_shell(mesh);
}

// How much energy is won, as a share of that at the start, where `a` meets `b` or, without it, a wall.
double rise_where_tumbling_meet(int a, std::optional<int> b, double restitution, double friction,
                                double time_step, core::Random& random) {
  const auto draw = [&] {
    const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
    return Vec3(x, y, z);
  };
  test::Scene scene;
  scene.settings.gravity.setZero();
  scene.settings.time_step = time_step;
  const auto throw_in = [&](int kind, double side) {
    auto& body = scene.add(make_tumbling(kind));
    body.pose.translation.x() = 0.2 * side;
    body.pose.rotation = test::random_rotation(random);
    body.velocity = Vec3(-side * random.uniform(3.0, 15.0), 0, 0) + draw();
    body.angular_velocity = 60.0 * draw();
  };
  throw_in(a, 1.0);
  if (b)
    throw_in(*b, -1.0);
  else
    scene.add(test::make_box(Vec3(0.05, 0.8, 0.7), Vec3(-0.2, 0, 0), false));
  for (body::Body& body : scene.bodies) {
    body.restitution = restitution;
    body.friction = friction;
  }
  const double start = scene.kinetic();
  double most = start;
  for (int i = 0; i < 10; ++i) {
    scene.step();
    most = std::max(most, scene.kinetic());
  }
  return most / start - 1.0;
}

// A splinter whirls in the wedge between a floor and a block of some thousand times its mass that comes down
// on it. By how much the energy grows in a step at most, J.
double rise_of_wedged(std::uint64_t seed) {
  core::Random random(seed);
  test::Scene scene;
  scene.settings.has_sleep = false;
  scene.add(test::make_plane());
  const double tilt = random.uniform(0.05, 0.4), half = 0.05;
  auto block = test::make_box(Vec3(half, 0.03, half), Vec3::Zero(), true, 2400.0);
  block.pose.rotation = dynamics::rotation_by(Vec3(0, 0, tilt));
  // Its lower edge is at x = 0.
  const Vec3 edge = block.pose.rotation * Vec3(-half, -0.03, 0.0);
  block.pose.translation = Vec3(0, 2e-4, 0) - edge;
  block.angular_velocity = Vec3(0, 0, -random.uniform(1.0, 10.0));
  block.velocity = block.angular_velocity.cross(-edge);
  scene.add(block);
  const double thick = random.uniform(2e-4, 1e-3), length = random.uniform(0.003, 0.01);
  auto splinter = test::make_box(Vec3(length, thick, 2.0 * thick), Vec3::Zero(), true, 2400.0);
  const double lift = random.uniform(1.5, 6.0) * thick;
  splinter.pose.rotation =
      dynamics::rotation_by(Vec3(random.uniform(-1, 1), random.uniform(-3, 3), 0.0) * 0.1);
  splinter.pose.translation = Vec3(2.2 * lift / core::sin(tilt) + length, lift, random.uniform(-0.02, 0.02));
  for (int i = 0; i < 3; ++i) splinter.angular_velocity[i] = random.uniform(-900, 900);
  scene.add(splinter);
  for (body::Body& b : scene.bodies) {
    b.friction = 0.65;
    b.may_break = true;
  }
  double most = 0.0, last = scene.energy();
  for (int i = 0; i < 24; ++i) {
    scene.step();
    most = std::max(most, scene.energy() - last);
    last = scene.energy();
  }
  return most;
}

}  // namespace

TEST_CASE("what falls and rubs in a room only loses energy") {
  check_settling(static_cast<int>(test::how_many(4, 1)));
}

TEST_CASE("what falls and rubs in a room for 60 s", "[.][long]") {
  check_settling(60);
}

TEST_CASE("what tumbles and meets wins no energy, however far it turns in a step") {
  core::Random random(11);
  double worst = 0.0;
  for (int round = 0; round < static_cast<int>(test::how_many(900, 90)); ++round) {
    const int a = round % 5, b = round / 5 % 6;
    const double restitution = 0.5 * (round / 30 % 3), friction = restitution < 1.0 ? 0.4 * (round % 2) : 0.0;
    const double time_step = round / 90 % 2 == 0 ? 1.0 / 60.0 : 1.0 / 120.0;
    const double rise = rise_where_tumbling_meet(a, b < 5 ? std::optional(b) : std::nullopt, restitution,
                                                 friction, time_step, random);
    INFO("round " << round);
    CHECK(rise < 1e-8);
    worst = std::max(worst, rise);
  }
  WARN("greatest rise " << worst);
}

TEST_CASE("a closed room never has more energy than it began with") {
  const long steps = test::how_many(2000, 200);
  for (const double restitution : {1.0, 0.9}) check_room(restitution, steps, steps / 200);
}

TEST_CASE("a closed room over 1e5 steps", "[.][long]") {
  check_room(1.0, 100000, 500);
  // Speeds fall as 1 / time (Haff 1983), so collisions grow only as its logarithm: 394 to 751 steps with
  // impulses in eight seeds, after which .09 to .7 % of the energy is left.
  CHECK(check_room(0.5, 100000, 250) < 0.01);
}

TEST_CASE("a splinter on a floor that resists its rolling wins no energy, whichever way it lies") {
  double most = 0.0;
  for (int k = 0; k < 24; ++k) {
    test::Scene scene;
    scene.settings.has_sleep = false;
    scene.add(test::make_plane()).rolling_friction = 2e-3;
    auto mesh = test::square_mesh(9e-4, 1);
    for (Vec3& v : mesh.positions) v.z() = 0.1 * v.z() + 0.1 * v.x();
    auto splinter = test::make_shell(mesh);
    splinter.pose.translation.y() = 2e-3;
    splinter.pose.rotation = dynamics::rotation_by(Vec3(0.3 * k, 1.0 + 0.2 * k, 0.7 - 0.1 * k));
    splinter.velocity = Vec3(0.5, -3.0, 0.1);
    scene.add(splinter);
    const double energy = scene.energy();
    for (int i = 0; i < 60; ++i) {
      scene.step();
      most = std::max(most, scene.energy() / energy);
    }
  }
  CHECK(most <= 1.0 + 1e-3);
}

TEST_CASE("a splinter that whirls in a wedge does not throw off the block that comes down on it") {
  // Of 1400 these are some of the 22 in which a step won more than a fifth of a joule, up to 45 J: the load
  // of one substep began the next along arms that had turned by a quarter of a radian.
  for (const std::uint64_t seed : {65, 93, 119, 197, 324, 386, 493, 498, 646, 734, 765, 1069, 1193}) {
    CAPTURE(seed);
    CHECK(rise_of_wedged(seed) < 0.05);
  }
}

TEST_CASE("elastic balls whose normal turns while they meet bounce all the same") {
  // They pass each other at an angle: their straight ways touch a hair before the contact's plane says so.
  for (const double rate : {60.0, 120.0, 240.0, 960.0}) {
    for (int place = 0; place < 20; ++place) {
      test::Scene scene;
      scene.settings.gravity.setZero();
      scene.settings.time_step = 1.0 / rate;
      auto& first = scene.add(test::make_sphere(0.05, Vec3(-0.050339, 0.447064 + 1e-4 * place, 0.170242)));
      first.velocity = Vec3(-0.8869, -1.65894, 0.70257);
      auto& second = scene.add(test::make_sphere(0.05, Vec3(0.050345, 0.412884, 0.158445)));
      second.velocity = Vec3(-1.67078, 2.00338, 0.47959);
      for (body::Body& b : scene.bodies) {
        b.friction = 0.0;
        b.restitution = 1.0;
      }
      const double start = scene.kinetic();
      for (double time = 0.0; time < 0.02; time += scene.settings.time_step) scene.step();
      INFO(rate << " steps a second, place " << place);
      CHECK(scene.kinetic() == Approx(start).epsilon(1e-4));
      CHECK((scene.bodies[0].velocity - Vec3(-0.8869, -1.65894, 0.70257)).norm() > 1.0);
    }
  }
}

}  // namespace shatterbox
