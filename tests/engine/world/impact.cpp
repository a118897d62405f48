#include "engine/world/impact.h"

#include <catch2/catch.hpp>

#include "engine/core/random.h"

using namespace shatterbox;
using world::Load;

namespace {

body::Body make_sphere(body::BodyId id, double radius, double mass) {
  auto shape = std::make_shared<body::Shape>();
  shape->radius = shape->bounding_radius = radius;
  shape->mass = mass;
  shape->inertia = 0.4 * mass * radius * radius * Mat3::Identity();
  body::Body body;
  body.id = id;
  body.inverse_mass = 1.0 / mass;
  body.inverse_inertia = shape->inertia.inverse();
  body.shape = shape;
  return body;
}

body::LoggedImpulse push(body::BodyId a, body::BodyId b, const Vec3& point, const Vec3& impulse,
                         body::ImpulseKind kind = body::ImpulseKind::collision) {
  body::LoggedImpulse entry;
  entry.kind = kind;
  entry.body_a = a;
  entry.body_b = b;
  entry.point_world = entry.point_a = entry.point_b = point;
  entry.impulse_world = entry.impulse_a = impulse;
  entry.impulse_b = -impulse;
  entry.normal_world = impulse.normalized();
  return entry;
}

}  // namespace

TEST_CASE("impulses are gathered by other body, place and direction, their sum is kept") {
  const body::Body struck = make_sphere(1, 1.0, 2.0);
  const body::ImpulseLog log{push(1, 2, Vec3(0, -1, 0), Vec3(0, 3, 0)),
                             push(1, 2, Vec3(0.1, -1, 0), Vec3(0, 1, 0)),
                             push(1, 2, Vec3(1, 0, 0), Vec3(-2, 0, 0)),
                             push(3, 1, Vec3(0, -1, 0), Vec3(0, -5, 0)),
                             push(1, 2, Vec3(0, -1, 0), Vec3(0, 9, 0), body::ImpulseKind::contact),
                             push(4, 5, Vec3(0, -1, 0), Vec3(0, 7, 0))};
  const auto loads = world::gather_loads(world::sort_by_body(log, {struck.id})[0],
                                         body::ImpulseKind::collision, struck, 0.25, 0.5);
  REQUIRE(loads.size() == 3);
  Vec3 sum = Vec3::Zero();
  for (const Load& load : loads) sum += load.impulse_body;
  CHECK((sum - Vec3(-2, 9, 0)).norm() < 1e-15);  // minus the impulse on the other where the struck body is b
  CHECK(loads[0].other == 3);
  CHECK((loads[0].impulse_body - Vec3(0, 5, 0)).norm() < 1e-15);
  CHECK(loads[1].impulse_body.y() == Approx(4.0));
  CHECK(loads[1].point_body.x() == Approx(0.025));  // the impulses' centre
}

TEST_CASE("a load is as the struck body felt it, wherever it has gone since") {
  body::Body struck = make_sphere(1, 1.0, 2.0);
  struck.pose.rotation = Quat(Eigen::AngleAxisd(core::kPi / 2.0, Vec3::UnitZ()));
  struck.pose.translation = Vec3(5, 0, 0);
  body::LoggedImpulse entry = push(2, 1, Vec3(5, 1, 0), Vec3(0, 1, 0));
  entry.point_b = Vec3(1, 0, 0);
  entry.impulse_b = Vec3(-1, 0, 0);
  const auto loads = world::gather_loads({&entry}, body::ImpulseKind::collision, struck, 0.25, 0.0);
  REQUIRE(loads.size() == 1);
  CHECK((loads[0].point_body - Vec3(1, 0, 0)).norm() < 1e-15);
  CHECK((loads[0].impulse_body - Vec3(-1, 0, 0)).norm() < 1e-15);
  CHECK((loads[0].other_impulse - Vec3(0, 1, 0)).norm() < 1e-15);
  CHECK((loads[0].point_world - Vec3(5, 1, 0)).norm() < 1e-15);
}

TEST_CASE("one impulse in parts is the same event as the whole") {
  Load whole;
  whole.other = 2;
  whole.point_body = Vec3(0, -1, 0);
  whole.impulse_body = Vec3(0, 8, 0);
  std::vector<Load> event;
  for (int i = 0; i < 8; ++i) {
    Load part = whole;
    part.impulse_body /= 8.0;
    part.time = 0.001 * i;
    world::add_to_event(event, {part}, 0.25);
  }
  REQUIRE(event.size() == 1);
  CHECK((event[0].impulse_body - whole.impulse_body).norm() < 1e-14);
  CHECK(event[0].time == Approx(0.007));
}

TEST_CASE("what made a piece is charged once: of whom it met up to that impulse and of its siblings wholly") {
  world::ImpactMemory piece, sibling;
  piece.charged_until = sibling.charged_until = 0.01;
  piece.charged_event = sibling.charged_event = 5;
  piece.charged_other = 2;
  piece.charged_left = 3.0;
  Load load;
  load.other = 2;
  load.impulse_body = Vec3(0, 2, 0);
  load.other_impulse = Vec3(0, -2, 0);
  load.time = 0.005;
  CHECK(world::take_charged(piece, nullptr, load));
  CHECK(piece.charged_left == Approx(1.0));
  CHECK_FALSE(world::take_charged(piece, nullptr, load));
  CHECK(load.impulse_body.y() == Approx(1.0));
  CHECK(load.other_impulse.y() == Approx(-1.0));
  CHECK(piece.charged_left == 0.0);
  CHECK_FALSE(world::take_charged(piece, nullptr, load));
  CHECK(load.impulse_body.y() == Approx(1.0));
  load.other = 7;
  CHECK(world::take_charged(piece, &sibling, load));
  CHECK_FALSE(world::take_charged(piece, nullptr, load));
  sibling.charged_event = 6;
  CHECK_FALSE(world::take_charged(piece, &sibling, load));
  piece.charged_left = 3.0;
  load.other = 2;
  load.time = 0.011;
  CHECK_FALSE(world::take_charged(piece, nullptr, load));
  CHECK(piece.charged_left == 3.0);
}

TEST_CASE("effective mass: head-on, off-centre and against a fixed body") {
  body::Body a = make_sphere(1, 0.5, 2.0);
  body::Body b = make_sphere(2, 0.5, 6.0);
  b.pose.translation = Vec3(1, 0, 0);
  const Vec3 point(0.5, 0, 0);
  CHECK(world::effective_mass(a, &b, point, Vec3::UnitX()) == Approx(1.5));
  CHECK(world::effective_mass(a, nullptr, point, Vec3::UnitX()) == Approx(2.0));
  // Across the line of centres a sphere gives way by turning too: 1/m + r^2/I = 3.5/m.
  CHECK(world::effective_mass(a, nullptr, point, Vec3::UnitY()) == Approx(2.0 / 3.5));
  b.inverse_mass = 0.0;
  CHECK(world::effective_mass(b, nullptr, point, Vec3::UnitX()) == 0.0);
}

TEST_CASE("a piece is seated beside another where they press at one place of their common material") {
  body::Body a = make_sphere(3, 0.1, 1.0), b = make_sphere(4, 0.1, 2.0);
  const auto move_origin = [](body::Body& body, const Vec3& origin) {
    auto shape = std::make_shared<body::Shape>(*body.shape);
    shape->material_from_body = origin;
    shape->thickness = shape->seat = 0.001;
    body.shape = shape;
  };
  move_origin(a, Vec3(1, 0, 0));
  move_origin(b, Vec3(1.2, 0, 0));
  a.family = b.family = 2;
  Load load;
  load.other = 4;
  load.point_body = Vec3(0.1, 0, 0);
  load.other_point = Vec3(-0.1, 0.0009, 0);
  CHECK(world::is_seated(a, b, load));
  load.other_point.y() = 0.0011;  // they have come apart by more than a thickness
  CHECK_FALSE(world::is_seated(a, b, load));
  load.other_point.y() = 0.0;
  b.family = 7;  // a piece of another body
  CHECK_FALSE(world::is_seated(a, b, load));
  a.family = b.family = 0;
  CHECK_FALSE(world::is_seated(a, b, load));
}

TEST_CASE("what passes through a piece to its seated neighbours does not load it") {
  Load from_floor;
  from_floor.impulse_body = Vec3(0, 10, 0);
  from_floor.other_impulse = Vec3(0, -10, 0);
  std::vector<Load> loads{from_floor};
  world::keep_own_share(loads, Vec3(0, -7.5, 3));
  REQUIRE(loads.size() == 1);
  CHECK((loads[0].impulse_body - Vec3(0, 2.5, 0)).norm() < 1e-12);
  CHECK((loads[0].other_impulse - Vec3(0, -2.5, 0)).norm() < 1e-12);
  world::keep_own_share(loads, Vec3(0, 1, 0));  // pushed along: the load is what it was
  CHECK((loads[0].impulse_body - Vec3(0, 2.5, 0)).norm() < 1e-12);
  world::keep_own_share(loads, Vec3(0, -4, 0));  // all of it passes through
  CHECK(loads.empty());
  world::keep_own_share(loads, Vec3(0, -4, 0));
  CHECK(loads.empty());
}
