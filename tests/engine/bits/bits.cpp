// The same bits: over threads and repeats, beside what is far away; and the same scene, to rounding, turned
// or in another order.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <thread>
#include <vector>

#include "engine/core/parallel.h"
#include "tests/engine/bits/scene.h"
#include "tests/support/sanitized.h"

using namespace shatterbox;

TEST_CASE("every step has the same bits on one to eight threads, and again") {
  core::set_thread_count(1);
  const std::vector<std::uint64_t> expected = test::play_hashes();
  {
    world::World w = test::make_everything();
    for (int i = 0; i < test::kBitSteps; ++i) w.step();
    REQUIRE(w.report().breaks.size() >= 2);  // of the ball and the block
    REQUIRE(w.state_hash() == expected.back());
  }
  for (const int count : test::kIsSanitized ? std::vector{3} : std::vector{2, 3, 4, 5, 6, 7, 8}) {
    core::set_thread_count(count);
    CAPTURE(count);
    CHECK(test::play_hashes() == expected);
  }
  core::set_thread_count(0);
}

TEST_CASE("a world that was kept in mid-run goes on to the same hash") {
  const std::vector<std::uint64_t> expected = test::play_hashes();
  world::World w = test::make_everything();
  for (std::size_t kept_at = 0; kept_at < expected.size(); ++kept_at) {
    if (test::kIsSanitized && kept_at != 2) {
      w.step();
      continue;
    }
    // Twice: what the first does must not change what is kept, nor the world that it was kept of.
    const world::World kept = w.copy();
    for (int time = 0; time < 2; ++time) {
      world::World on = kept.copy();
      for (std::size_t i = kept_at; i < expected.size(); ++i) {
        on.step();
        CAPTURE(kept_at, time, i);
        CHECK(on.state_hash() == expected[i]);
      }
    }
    w.step();
    CHECK(w.state_hash() == expected[kept_at]);
  }
}

TEST_CASE("copies of a world step in threads of their own, and go on to the same hash") {
  const std::vector<std::uint64_t> expected = test::play_hashes();
  constexpr std::size_t kCopies = 3;
  world::World w = test::make_everything();
  std::array<std::uint64_t, kCopies> ends{};
  {
    std::vector<std::jthread> threads;
    for (std::uint64_t& end : ends)
      threads.emplace_back([&end, on = w.copy()]() mutable {
        for (int i = 0; i < test::kBitSteps; ++i) on.step();
        end = on.state_hash();
      });
  }
  for (const std::uint64_t end : ends) CHECK(end == expected.back());
}

TEST_CASE("a far body that touches nothing changes no bit of the others") {
  world::World alone = test::make_everything(), w = test::make_everything();
  world::BodyDescription far_box;
  far_box.form = world::BoxDescription{Vec3::Constant(0.3)};
  far_box.pose.translation = Vec3(500.0, 200.0, -300.0);
  far_box.angular_velocity = Vec3(0.0, 100.0, 0.0);  // though it spins
  const body::BodyId id = w.add_body(far_box).value();
  for (int i = 0; i < test::kBitSteps; ++i) {
    alone.step();
    w.step();
  }
  REQUIRE(w.bodies().size() == alone.bodies().size() + 1);
  REQUIRE(alone.report().breaks.size() >= 2);
  std::size_t k = 0;
  for (const body::Body& b : w.bodies()) {
    if (b.id == id) continue;
    const body::Body& other = alone.bodies()[k++];
    CAPTURE(b.name, k);
    CHECK(b.pose.translation == other.pose.translation);
    CHECK(b.pose.rotation.coeffs() == other.pose.rotation.coeffs());
    CHECK(b.velocity == other.velocity);
    CHECK(b.angular_velocity == other.angular_velocity);
    CHECK(b.shape->mass == other.shape->mass);
  }
}

namespace {

/// Three boxes stand, a fourth flies into them, then a thin ball breaks beside them; all turned about the
/// vertical and told in that order. Places are turned back.
struct Played {
  std::vector<Vec3> places;  // of boxes, by `order`'s numbers
  double area = 0.0, pieces = 0.0;
};

Played play_turned(double angle, const std::vector<int>& order, int steps) {
  const Quat turn(Eigen::AngleAxisd(angle, Vec3::UnitY()));
  world::World w{world::WorldSettings{}};
  material::Material glass = *material::find_preset("glass");
  glass.flaw_area = 1e-3;
  w.add_material(glass).value();
  geometry::Meshing meshing;
  meshing.edge_length = 0.01;
  world::ShellDescription shell;
  shell.mesh = geometry::make_sphere(0.04, meshing).value();
  shell.thickness = 0.5e-3;
  const auto add = [&](world::BodyDescription body, const Vec3& place, const Vec3& velocity) {
    body.pose.translation = turn * place;
    body.pose.rotation = turn;
    body.velocity = turn * velocity;
    return w.add_body(body).value();
  };
  world::BodyDescription ground, ball, box;
  ground.form = world::PlaneDescription{};
  w.add_body(ground).value();
  // First, for flaws go by the number of the body; and broken last, for how its shards collide decides in how
  // many parts a step is taken, for the boxes too.
  ball.form = shell;
  const body::BodyId whole = add(ball, Vec3(0.5, 0.34, 0), Vec3(0.1, -4, 0));
  box.form = world::BoxDescription{Vec3::Constant(0.05)};
  std::vector<body::BodyId> ids(4);
  for (const int k : order)
    ids[static_cast<std::size_t>(k)] = k < 3 ? add(box, Vec3(0, 0.0501 + 0.1002 * k, 0), Vec3::Zero())
                                             : add(box, Vec3(-0.2, 0.22, 0.012), Vec3(3, 0, 0));
  for (int i = 0; i < steps; ++i) w.step();
  Played played;
  for (const body::BodyId id : ids)
    for (const body::Body& b : w.bodies())
      if (b.id == id) played.places.push_back(turn.conjugate() * b.pose.translation);
  for (const world::BreakRow& row : w.report().breaks)
    if (row.id == whole) {
      played.area = row.new_area;
      played.pieces = static_cast<double>(row.pieces);
    }
  return played;
}

}  // namespace

TEST_CASE("a scene that is turned, or told in another order, is the same scene") {
  if (test::kIsSanitized) return;  // its steps are those of the tests above
  const Played plain = play_turned(0.0, {0, 1, 2, 3}, 20);
  REQUIRE(plain.pieces > 2.0);
  REQUIRE((plain.places[3] - Vec3(-0.2, 0.22, 0.012)).norm() > 0.05);
  const auto check_like = [&plain](const Played& other, double tolerance) {  // of a box's size
    for (std::size_t i = 0; i < plain.places.size(); ++i) {
      CAPTURE(i, plain.places[i].transpose(), other.places[i].transpose());
      CHECK((other.places[i] - plain.places[i]).norm() < tolerance * 0.1);
    }
    CHECK(other.pieces == plain.pieces);
    CHECK(other.area == Approx(plain.area).epsilon(1e-6));
  };
  // A hit that runs on through a stack makes more of how it stands: micrometres.
  check_like(play_turned(0.7, {0, 1, 2, 3}, 20), 3e-3);
  check_like(play_turned(-2.1, {0, 1, 2, 3}, 20), 3e-3);
  check_like(play_turned(0.0, {3, 1, 0, 2}, 20), 5e-3);  // sweeps go over pairs in another order
}
