// Who strikes, as what is struck sees him: by his section, his motion and where they met first.
#include "engine/world/striker.h"

#include <catch2/catch.hpp>

#include <numbers>
#include <variant>

#include "engine/geometry/generators.h"
#include "engine/world/world.h"

using namespace shatterbox;

namespace {

/// What a plate at the origin, which faces up, sees of a body that comes down on it.
fracture::Striker seen(
    const std::variant<world::PlaneDescription, world::BoxDescription, world::SphereDescription,
                       world::CapsuleDescription, world::ShellDescription, world::SolidDescription>& form,
    const Quat& turn, const Vec3& velocity = Vec3(0, -100, 0)) {
  world::World w(world::WorldSettings{});
  REQUIRE(w.add_material(*material::find_preset("steel")).ok());
  world::BodyDescription plate, other;
  plate.form = world::BoxDescription{Vec3(1.0, 0.01, 1.0)};
  plate.motion = body::Motion::fixed;
  plate.pose.translation = Vec3(0, -0.01, 0);
  const body::BodyId struck = w.add_body(plate).value();
  other.form = form;
  other.pose = {turn, Vec3(0, 1, 0)};
  other.velocity = velocity;
  body::LoggedImpulse hit;
  hit.kind = body::ImpulseKind::collision;
  hit.body_a = struck;
  hit.body_b = w.add_body(other).value();
  hit.point_a = Vec3(0.1, 0.01, 0.0);
  hit.impulse_a = Vec3(0, -1, 0);
  hit.impulse_b = turn.conjugate() * Vec3(0, 1, 0);
  hit.point_b = turn.conjugate() * Vec3(0.0, -0.05, 0.0);
  hit.closing_speed = -velocity.y();
  hit.time = 0.1;
  // What follows does not tell who came.
  body::LoggedImpulse later = hit;
  later.point_a = Vec3(0.3, 0.01, 0.0);
  later.impulse_a = Vec3(1, 0, 0);
  later.impulse_b = turn.conjugate() * Vec3(-1, 0, 0);
  later.time = 0.11;
  const std::vector<body::Body> bodies(w.bodies().begin(), w.bodies().end());
  const auto striker = world::find_striker({bodies, 0.45, 0.4}, {later, hit}, struck, hit.body_b);
  REQUIRE(striker);
  CHECK((striker->centre - Vec3(0.1, 0.06, 0.0)).norm() < 1e-12);
  CHECK(striker->time == Approx(0.5));
  CHECK(world::find_striker({bodies, 0.45, 0.4}, {}, struck, hit.body_b) == nullptr);
  // Who was turned away before he touched had not come yet, at this body or at a third one.
  body::LoggedImpulse missed = hit;
  missed.impulse_a = missed.impulse_b = Vec3::Zero();
  missed.time = 0.02;
  CHECK(world::find_striker({bodies, 0.45, 0.4}, {missed}, struck, hit.body_b) == nullptr);
  body::LoggedImpulse missed_third = missed;
  missed_third.body_a = hit.body_b + 1;
  const auto same =
      world::find_striker({bodies, 0.45, 0.4}, {missed, later, missed_third, hit}, struck, hit.body_b);
  REQUIRE(same);
  CHECK(same->time == striker->time);
  CHECK((same->speed * same->direction - striker->speed * striker->direction).norm() < 1e-12);
  // Who has met a third one before comes as fast as he closed, along the normal.
  body::LoggedImpulse third = hit;
  third.body_a = hit.body_b + 1;
  third.time = 0.05;
  later.closing_speed = 7.0;
  const auto turned_aside = world::find_striker({bodies, 0.45, 0.4}, {later, third}, struck, hit.body_b);
  REQUIRE(turned_aside);
  CHECK((turned_aside->speed * turned_aside->direction - Vec3(7, 0, 0)).norm() < 1e-12);
  return *striker;
}

Quat turned(double degrees, const Vec3& axis) {
  return Quat(Eigen::AngleAxisd(degrees * std::numbers::pi / 180.0, axis));
}

}  // namespace

TEST_CASE("a striker is seen by its section across its motion and how flat it is in front") {
  const double pi = std::numbers::pi;
  const fracture::Striker ball = seen(world::SphereDescription{0.05}, turned(30, Vec3::UnitX()));
  CHECK(section_of(ball).area == Approx(pi * 0.0025));
  CHECK(ball.flatness == 0.0);
  CHECK(ball.speed == Approx(100.0));
  CHECK((ball.direction + Vec3::UnitY()).norm() < 1e-12);
  CHECK(ball.mass == Approx(7850.0 * 4.0 / 3.0 * pi * 0.05 * 0.05 * 0.05));
  const fracture::Striker slanting =
      seen(world::SphereDescription{0.05}, Quat::Identity(), Vec3(100, -100, 0));
  CHECK(slanting.speed == Approx(100.0 * std::sqrt(2.0)));

  const world::BoxDescription box{Vec3(0.03, 0.05, 0.02)};
  const fracture::Striker flat = seen(box, Quat::Identity());
  CHECK(section_of(flat).area == Approx(0.06 * 0.04));
  CHECK(section_of(flat).perimeter == Approx(0.2));
  CHECK(flat.flatness == Approx(1.0));
  double last = 1.0;
  for (const double angle : {1.0, 2.0, 4.0, 8.0, 45.0}) {
    const fracture::Striker tilted = seen(box, turned(angle, Vec3::UnitX()));
    CHECK(tilted.flatness <= last);
    last = tilted.flatness;
    if (angle == 1.0) CHECK(last > 0.9);
  }
  CHECK(last < 0.2);

  const world::CapsuleDescription capsule{0.01, 0.1};
  CHECK(section_of(seen(capsule, Quat::Identity())).area == Approx(pi * 1e-4));
  CHECK(section_of(seen(capsule, turned(90, Vec3::UnitZ()))).area == Approx(pi * 1e-4 + 0.08 * 0.02));

  world::SolidDescription stone;
  stone.mesh = geometry::make_sphere(0.05, {0.01, 0.0, 1}).value();
  stone.is_breakable = false;
  const fracture::Striker round = seen(stone, Quat::Identity());
  CHECK(section_of(round).area == Approx(pi * 0.0025).epsilon(0.03));
  CHECK(round.flatness < 0.1);
}
