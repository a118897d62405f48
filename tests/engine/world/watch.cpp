// Who watches a world sees every stage of every step, and changes nothing.
#include <catch2/catch.hpp>
#include <map>

#include "engine/world/world.h"

using namespace shatterbox;

namespace {

/// A box and a ball that fall onto a plane, the ball not straight down.
world::World make_falling(double sideways) {
  world::World w{world::WorldSettings{}};
  REQUIRE(w.add_material(*material::find_preset("plaster")).ok());
  world::BodyDescription ground, box, ball;
  ground.form = world::PlaneDescription{};
  REQUIRE(w.add_body(ground).ok());
  box.name = "box";
  box.form = world::BoxDescription{Vec3::Constant(0.1)};
  box.pose.translation = Vec3(0, 0.105, 0);
  REQUIRE(w.add_body(box).ok());
  ball.name = "ball";
  ball.form = world::SphereDescription{0.1};
  ball.pose.translation = Vec3(1, 0.3, 0);
  ball.velocity = Vec3(sideways, 0, 0);
  REQUIRE(w.add_body(ball).ok());
  return w;
}

struct Seen {
  long step;
  std::string stage;
  std::map<body::BodyId, world::BodyBits> bodies;
};

std::vector<Seen> watch_steps(world::World& w, int steps) {
  std::vector<Seen> seen;
  w.watch([&seen](const world::Moment& moment) {
    CHECK(moment.bits.size() == moment.bodies.size());
    CHECK(moment.part >= 1);
    CHECK(moment.part <= moment.parts);
    Seen one{moment.step, moment.stage, {}};
    for (const world::BodyBits& bits : moment.bits) one.bodies[bits.id] = bits;
    seen.push_back(one);
  });
  for (int i = 0; i < steps; ++i) w.step();
  return seen;
}

}  // namespace

TEST_CASE("a watched world is the same world") {
  world::World plain = make_falling(1.0), watched = make_falling(1.0);
  const auto seen = watch_steps(watched, 60);
  for (int i = 0; i < 60; ++i) plain.step();
  CHECK(watched.state_hash() == plain.state_hash());
  CHECK(seen.front().step == 1);
  CHECK(seen.front().stage == "acts");
  CHECK(seen.back().step == 60);
  CHECK(seen.back().stage == "sleep");
  watched.watch({});
  watched.step();
  CHECK(seen.back().step == 60);
}

TEST_CASE("the first moment in which two worlds differ names body and quantity") {
  world::World a = make_falling(1.0), b = make_falling(1.0);
  const body::BodyId box = a.bodies()[1].id, ball = a.bodies()[2].id;
  (void)watch_steps(a, 10);
  (void)watch_steps(b, 10);
  // One bit of one velocity.
  REQUIRE(b.push_body(ball, Vec3(0, 0, 1e-13), b.bodies()[2].pose.translation));
  const auto of_a = watch_steps(a, 1), of_b = watch_steps(b, 1);
  REQUIRE(of_a.size() == of_b.size());
  CHECK(of_a[0].stage == "acts");
  for (std::size_t q = 0; q < world::kBodyQuantities.size(); ++q) {
    const bool is_velocity = std::string(world::kBodyQuantities[q]) == "velocity";
    CHECK((of_a[0].bodies.at(ball).quantities[q] == of_b[0].bodies.at(ball).quantities[q]) != is_velocity);
  }
  for (std::size_t i = 0; i < of_a.size(); ++i) CHECK(of_a[i].bodies.at(box) == of_b[i].bodies.at(box));
}
