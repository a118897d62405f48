// Thin shells on the ground, against solids, and as pieces that are born touching.
#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>

#include "engine/core/index.h"
#include "engine/core/parallel.h"
#include "engine/geometry/closest_points.h"
#include "tests/engine/dynamics/bodies.h"

namespace shatterbox {
namespace {

// A square plate cut into `count` fan pieces about its middle, each standing back from its cuts by half a
// `gap`.
std::vector<geometry::TriangleMesh> fan_pieces(double half, int count, double gap) {
  std::vector<geometry::TriangleMesh> pieces;
  const auto rim = [&](double turn) {
    const Vec3 way(core::cos(turn), 0, core::sin(turn));
    return Vec3(way * (half / way.cwiseAbs().maxCoeff()));
  };
  for (int k = 0; k < count; ++k) {
    const Vec3 middle(0.003, 0, -0.002);
    const Vec3 a = rim(2.0 * core::kPi * k / count), b = rim(2.0 * core::kPi * (k + 1) / count);
    const Vec3 out = (0.5 * (a + b) - middle).normalized();
    // Moving every side inwards by half the gap keeps the angles: shrink towards the incentre.
    const double la = (b - middle).norm(), lb = (a - middle).norm(), lm = (a - b).norm();
    const Vec3 incentre = (la * a + lb * b + lm * middle) / (la + lb + lm);
    const double inradius = (a - middle).cross(b - middle).norm() / (la + lb + lm);
    const double keep = 1.0 - 0.5 * gap / inradius;
    geometry::TriangleMesh mesh;
    const auto put = [&](const Vec3& p) { mesh.positions.push_back(incentre + keep * (p - incentre)); };
    put(middle);
    put(a);
    put(b);
    put(0.5 * (a + middle));
    put(0.5 * (b + middle));
    mesh.triangles = {{0, 4, 3}, {3, 4, 2}, {3, 2, 1}};
    (void)out;
    pieces.push_back(mesh);
  }
  return pieces;
}

test::Scene pieces_scene(double height, const Vec3& velocity, const Vec3& spin, int count = 30) {
  test::Scene scene;
  if (height > 0.0) {
    scene.add(test::make_plane());
  } else {
    scene.settings.gravity.setZero();
  }
  for (auto& mesh : fan_pieces(0.1, count, 2e-5)) {
    for (Vec3& p : mesh.positions) p.y() += height;
    auto b = test::make_shell(mesh);
    b.velocity = velocity + spin.cross(b.pose.translation - Vec3(0, height, 0));
    b.angular_velocity = spin;
    scene.add(b);
  }
  return scene;
}

std::size_t row_of(const test::Scene& scene, body::BodyId id) {
  std::size_t row = 0;
  while (scene.state.bodies[row].id != id) ++row;
  return row;
}

double corners_to_faces(const body::Body& a, const body::Body& b) {
  double least = 1e300;
  const auto corner = [&](int v) { return b.pose.apply(b.shape->surface.positions[core::at(v)]); };
  for (const Vec3& p : a.shape->surface.positions)
    for (const auto& t : b.shape->surface.triangles)
      least = std::min(
          least,
          geometry::closest_on_triangle(a.pose.apply(p), corner(t[0]), corner(t[1]), corner(t[2])).distance);
  return least;
}

}  // namespace

TEST_CASE("pieces that fly on from one body neither explode nor stick") {
  auto scene = pieces_scene(0.0, Vec3(1, 2, 0.5), Vec3(1, 4, 2));
  const double start = scene.kinetic();
  const Vec3 momentum = scene.momentum(), spin = scene.spin();
  double most = start;
  for (int i = 0; i < 240; ++i) {
    scene.step();
    most = std::max(most, scene.kinetic());
  }
  WARN("pieces: energy gained " << most / start - 1.0 << ", kept " << scene.kinetic() / start << ", cut "
                                << scene.report.failsafe_steps);
  CHECK(most <= start * (1.0 + 1e-9));
  CHECK(scene.kinetic() > 0.98 * start);
  CHECK((scene.momentum() - momentum).norm() < 1e-10 * momentum.norm());
  CHECK((scene.spin() - spin).norm() < 1e-8 * spin.norm());
}

TEST_CASE("pieces fall, rest and sleep, nothing goes below the ground") {
  auto scene = pieces_scene(0.5, Vec3(0.3, -1, 0), Vec3(1, 0.5, 2));
  double energy = scene.energy(), risen = 0.0, lowest = 1.0;
  int asleep_at = -1, cut = 0, hits = 0;
  for (int i = 0; i < 240 * 6; ++i) {
    scene.step();
    risen = std::max(risen, scene.energy() - energy);
    energy = scene.energy();
    lowest = std::min(lowest, scene.lowest());
    cut += scene.report.failsafe_steps;
    hits += scene.report.hits;
    bool anyone_awake = false;
    for (const auto& b : scene.bodies) anyone_awake = anyone_awake || (b.is_dynamic() && b.is_awake);
    if (!anyone_awake) {
      asleep_at = i;
      break;
    }
  }
  WARN("pieces dropped: asleep after " << asleep_at / 240.0 << " s, rise of energy " << risen << " of "
                                       << energy << " J, lowest " << lowest << ", cut " << cut << ", hits "
                                       << hits);
  CHECK(asleep_at > 0);
  CHECK(lowest > -1e-10);
  CHECK(risen < 1e-4);
}

TEST_CASE("a bowl comes to rest on the ground") {
  test::Scene scene;
  scene.add(test::make_plane());
  auto b = test::make_shell(test::bowl_mesh(0.1, 6, 16));
  b.pose.translation.y() = 0.4;
  b.pose.rotation = dynamics::rotation_by(Vec3(2.0, 0.3, 0.5));
  b.rolling_friction = 2e-4;
  scene.add(b);
  double lowest = 1.0, energy = scene.energy(), risen = 0.0;
  int i = 0;
  for (; i < 240 * 20 && scene.bodies[1].is_awake; ++i) {
    scene.step();
    lowest = std::min(lowest, scene.lowest());
    risen = std::max(risen, scene.energy() - energy);
    energy = scene.energy();
  }
  WARN("bowl: asleep after " << i / 240.0 << " s, rise of energy " << risen << " of " << energy << ", lowest "
                             << lowest);
  CHECK(!scene.bodies[1].is_awake);
  CHECK(lowest > -1e-10);
  CHECK(risen < 1e-4 * energy);
}

TEST_CASE("a small plate slides and spins on the ground as far as friction lets it") {
  for (const double rate : {60.0, 240.0}) {
    for (const double spin : {0.0, 20.0, 150.0}) {
      for (const double mu : {0.0, 0.4}) {
        test::Scene scene;
        scene.settings.time_step = 1.0 / rate;
        scene.add(test::make_plane());
        auto& plate = scene.add(test::make_shell(test::square_mesh(0.005, 1)));  // goes far against its size
        plate.friction = scene.bodies[0].friction = mu;
        plate.pose.translation.y() = 5e-6;
        plate.velocity.x() = 4.0;
        plate.angular_velocity.y() = spin;
        int cut = 0;
        for (int i = 0; i < static_cast<int>(rate) / 4; ++i) {
          scene.step();
          cut += scene.report.failsafe_steps;
        }
        INFO(rate << " steps a second, spin " << spin << " rad/s, friction " << mu);
        CHECK(cut == 0);
        CHECK(scene.bodies[1].pose.translation.x() ==
              Approx(4.0 * 0.25 - 0.5 * mu * 9.81 * 0.0625).epsilon(0.01));
      }
    }
  }
}

TEST_CASE("shards of any speed stay above the ground") {
  core::Random random(3);
  for (const double speed : {1.0, 30.0, 300.0, 1000.0}) {
    auto scene = pieces_scene(0.5, Vec3(0.1 * speed, -speed, 0), Vec3(3, 1, 2) * std::min(speed, 100.0), 12);
    double lowest = 1.0;
    int cut = 0;
    for (int i = 0; i < 240; ++i) {
      scene.step();
      lowest = std::min(lowest, scene.lowest());
      cut += scene.report.failsafe_steps;
    }
    INFO("speed " << speed << " cut " << cut);
    CHECK(lowest > -1e-10);
  }
}

TEST_CASE("a fast ball does not pass a plate") {
  for (const double speed : {5.0, 50.0, 500.0}) {
    for (const int cells : {1, 8}) {
      for (const bool is_free : {false, true}) {
        test::Scene scene;
        scene.settings.gravity.setZero();
        scene.add(test::make_shell(test::square_mesh(0.5, cells), is_free));
        auto& ball = scene.add(test::make_sphere(0.03, Vec3(0.113, 1.7, 0.071), 7800.0));
        ball.velocity.y() = -speed;
        bool has_passed = false, was_felt = false;
        double energy = scene.kinetic();
        for (int i = 0; i < 480 && !has_passed; ++i) {
          scene.step();
          CHECK(scene.kinetic() <= energy * (1 + 1e-9));
          energy = scene.kinetic();
          const Vec3 seen = scene.bodies[0].pose.apply_inverse(scene.bodies[1].pose.translation);
          was_felt = was_felt || !scene.log.empty();
          has_passed = seen.y() < 0.0 && seen.cwiseAbs().maxCoeff() < 0.5;
          if (was_felt && i > 200) break;
        }
        INFO("speed " << speed << " cells " << cells << " free " << is_free);
        CHECK(was_felt);
        CHECK(!has_passed);
      }
    }
  }
}

TEST_CASE("a shard that a fast ball strikes does not leave through the ground in the same step") {
  for (const double height : {0.05, 0.3}) {
    test::Scene scene;
    scene.add(test::make_plane());
    scene.add(test::make_box(Vec3(0.5, 0.01, 0.5), Vec3(0, 0.02, 0), false));
    auto shard = test::make_shell(test::square_mesh(0.03, 3));
    shard.pose.translation = Vec3(0, height, 0);
    scene.add(shard);
    auto& ball = scene.add(test::make_sphere(0.02, Vec3(0.004, height + 0.5, 0.003), 7800.0));
    ball.velocity = Vec3(0, -300, 0);
    double lowest = 1.0;
    for (int i = 0; i < 60; ++i) {
      scene.step();
      lowest = std::min(lowest, scene.lowest());
    }
    INFO("height " << height);
    CHECK(lowest > 0.0);
  }
}

TEST_CASE("surfaces are as far apart as a pair remembers") {
  auto scene = pieces_scene(0.15, Vec3(0.3, -1, 0), Vec3(1, 0.5, 2), 16);
  int known = 0, told = 0;
  double least_left = 1e300;
  for (int i = 0; i < 240; ++i) {
    scene.step();
    for (const dynamics::PairState& pair : scene.state.pairs) {
      const std::size_t a = row_of(scene, pair.body_a), b = row_of(scene, pair.body_b);
      const double gone =
          scene.state.bodies[a].travelled + scene.state.bodies[b].travelled - pair.clear_since;
      if (pair.clear - gone <= 0.0) continue;
      ++known;
      const double apart = std::min(corners_to_faces(scene.bodies[a], scene.bodies[b]),
                                    corners_to_faces(scene.bodies[b], scene.bodies[a]));
      told += pair.clear - gone > 0.5 * apart ? 1 : 0;
      least_left = std::min(least_left, apart - (pair.clear - gone));
    }
  }
  CHECK(least_left >= 0.0);
  CHECK(known > 1000);
  CHECK(told > 100);
}

TEST_CASE("the same bits with and without caches, and on any number of threads") {
  const auto run = [](bool has_caches, int threads) {
    core::set_thread_count(threads);
    auto scene = pieces_scene(0.15, Vec3(0.3, -1, 0), Vec3(1, 0.5, 2), 16);
    scene.settings.has_caches = has_caches;
    for (int i = 0; i < 240; ++i) scene.step();
    core::set_thread_count(0);
    return scene.hash();
  };
  const auto expected = run(true, 1);
  CHECK(run(false, 1) == expected);
  CHECK(run(true, 2) == expected);
  CHECK(run(true, 4) == expected);
}

TEST_CASE("going back to a copy of the state repeats the same bits") {
  auto scene = pieces_scene(0.15, Vec3(0.3, -1, 0), Vec3(1, 0.5, 2), 8);
  for (int i = 0; i < 100; ++i) scene.step();
  auto copy = scene;
  for (int i = 0; i < 50; ++i) scene.step();
  for (int i = 0; i < 50; ++i) copy.step();
  CHECK(copy.hash() == scene.hash());
}

}  // namespace shatterbox
