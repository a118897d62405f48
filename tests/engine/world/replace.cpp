#include "engine/world/replace.h"

#include <catch2/catch.hpp>

#include "engine/world/world.h"

using namespace shatterbox;

namespace {

body::Body make_ball(body::BodyId id, double mass) {
  auto shape = std::make_shared<body::Shape>();
  shape->radius = shape->bounding_radius = 0.1;
  shape->mass = mass;
  shape->inertia = 0.4 * mass * 0.01 * Mat3::Identity();
  body::Body body;
  body.id = id;
  body.inverse_mass = 1.0 / mass;
  body.inverse_inertia = shape->inertia.inverse();
  body.shape = shape;
  return body;
}

double energy(const world::MovingState& moving) {
  double sum = 0.0;
  for (const body::Body& body : moving.bodies) sum += body::kinetic_energy(body);
  return sum;
}

world::MovingState make_pair_of_balls() {
  world::MovingState moving;
  moving.bodies = {make_ball(1, 2.0), make_ball(2, 3.0)};
  moving.bodies[1].pose.translation = Vec3(0.2, 0.01, 0);
  moving.bodies[0].velocity = Vec3(4, 0, 1);
  moving.bodies[0].angular_velocity = Vec3(0, 3, 2);
  moving.bodies[1].velocity = Vec3(-1, 0.5, 0);
  return moving;
}

world::EvaluatedImpact make_impact() {
  world::EvaluatedImpact impact;
  impact.id = 1;
  impact.hardest.other = 2;
  impact.hardest.point_body = Vec3(0.1, 0, 0);
  impact.hardest.impulse_body = Vec3(-5, 0.2, 0.1);
  return impact;
}

}  // namespace

TEST_CASE("cracks are paid for exactly, out of the relative motion, with momentum kept") {
  world::MovingState moving = make_pair_of_balls();
  const double before = energy(moving);
  const Vec3 momentum = 2.0 * moving.bodies[0].velocity + 3.0 * moving.bodies[1].velocity;
  const Vec3 spin = body::angular_momentum(moving.bodies[0]) + body::angular_momentum(moving.bodies[1]);
  body::ImpulseLog log;
  CHECK(world::pay_for_cracks(moving, make_impact(), 1.5, log) == Approx(1.5));
  CHECK(before - energy(moving) == Approx(1.5).epsilon(1e-12));
  CHECK((2.0 * moving.bodies[0].velocity + 3.0 * moving.bodies[1].velocity - momentum).norm() < 1e-14);
  CHECK((body::angular_momentum(moving.bodies[0]) + body::angular_momentum(moving.bodies[1]) - spin).norm() <
        1e-14);
  REQUIRE(log.size() == 1);
  CHECK(log[0].kind == body::ImpulseKind::fracture);
}

TEST_CASE("cracks cannot take more than there is, and nothing from bodies that part") {
  world::MovingState moving = make_pair_of_balls();
  body::ImpulseLog log;
  const double before = energy(moving);
  const double paid = world::pay_for_cracks(moving, make_impact(), 1e9, log);
  CHECK(paid < 0.5 * 1.2 * 30.0);  // reduced mass, closing below sqrt(30) m/s
  CHECK(before - energy(moving) == Approx(paid));
  CHECK(world::pay_for_cracks(moving, make_impact(), 1.0, log) == Approx(0.0).margin(1e-12));
}

TEST_CASE("who pressed and has broken since pays with its nearest piece, or not at all") {
  world::MovingState moving = make_pair_of_balls();
  moving.bodies[1].id = 5;
  moving.bodies.push_back(make_ball(6, 1.0));
  moving.bodies[2].pose.translation = Vec3(2, 0, 0);
  moving.memories[5].charged_event = moving.memories[6].charged_event = 2;
  const Vec3 momentum = 2.0 * moving.bodies[0].velocity + 3.0 * moving.bodies[1].velocity;
  body::ImpulseLog log;
  CHECK(world::pay_for_cracks(moving, make_impact(), 1.5, log) == Approx(1.5));
  CHECK((2.0 * moving.bodies[0].velocity + 3.0 * moving.bodies[1].velocity - momentum).norm() < 1e-14);
  CHECK(moving.bodies[2].velocity.isZero(0.0));
  REQUIRE(log.size() == 1);
  CHECK(log[0].body_b == 5);

  moving.memories.clear();
  const Vec3 velocity = moving.bodies[0].velocity;
  CHECK(world::pay_for_cracks(moving, make_impact(), 1.5, log) == 0.0);
  CHECK(moving.bodies[0].velocity == velocity);
  CHECK(log.size() == 1);
}

TEST_CASE("ways of bodies end where they break, and those of their pieces begin there") {
  const std::vector<body::Body> before{make_ball(1, 1.0), make_ball(2, 1.0)};
  std::vector<body::Body> after{make_ball(2, 1.0), make_ball(3, 0.5), make_ball(4, 0.5)};
  after[1].pose.translation = Vec3(1, 2, 3);
  std::vector<world::BreakRow> breaks(1);
  breaks[0].id = 1;
  breaks[0].born = {3, 4};
  std::vector<body::Way> ways{{1, {{0.25, {}}, {0.5, {}}}}, {2, {{0.5, {}}}}}, ended;
  world::divide_ways(before, breaks, after, 0.0, ways, ended);  // at the step's start there is no way yet
  CHECK(ended.empty());
  world::divide_ways(before, breaks, after, 0.5, ways, ended);
  REQUIRE(ended.size() == 1);
  CHECK(ended[0].id == 1);
  CHECK(ended[0].begin == 0.0);
  CHECK(ended[0].end == 0.5);
  CHECK(ended[0].points.size() == 2);
  CHECK(ended[0].former->shape == before[0].shape);
  REQUIRE(ways.size() == 3);
  CHECK(ways[0].id == 2);
  CHECK(ways[1].id == 3);
  CHECK(ways[1].begin == 0.5);
  REQUIRE(ways[1].points.size() == 1);
  CHECK(ways[1].points[0].pose.translation == Vec3(1, 2, 3));

  // What is born and breaks at one and the same time has no way.
  breaks[0].id = 3;
  breaks[0].born = {5};
  world::divide_ways(after, breaks, {make_ball(5, 0.5)}, 0.5, ways, ended);
  CHECK(ended.size() == 1);
  REQUIRE(ways.size() == 3);
  CHECK(ways[2].id == 5);

  // Who stood still until it broke has one all the same.
  breaks[0].id = 1;
  breaks[0].born = {6};
  world::divide_ways(before, breaks, {make_ball(6, 1.0)}, 0.75, ways, ended);
  REQUIRE(ended.size() == 2);
  CHECK(ended[1].end == 0.75);
  CHECK(ended[1].points.size() == 1);
}
