// Rigid impact zones: bodies that go as one keep their places to each other, their momentum, and their room.
#include "engine/dynamics/impact_zones.h"

#include <catch2/catch.hpp>

#include "tests/engine/dynamics/piles.h"

namespace shatterbox {
namespace {

using dynamics::ImpactZones;

/// Three boxes that fly and spin, each in its own way, over a floor; the step's ends as if nothing touched.
struct Flight {
  test::Scene scene;
  dynamics::MotionWork work;

  Flight() {
    scene.settings.time_step = 1.0 / 240.0;
    scene.add(test::make_plane());
    for (int k = 0; k < 3; ++k) {
      body::Body box =
          test::make_box(Vec3(0.1, 0.05 * (k + 1), 0.08), Vec3(0.3 * k, 1.0 + 0.05 * k, 0.1 * k));
      box.velocity = Vec3(1.0 - k, 2.0 * k - 1.0, 0.5);
      box.angular_velocity = Vec3(3.0, 4.0 * k, -2.0);
      scene.add(box);
    }
    scene.fly(work);
  }

  /// Of the ways of two bodies, about the origin: mass times way, and angular momentum times time.
  std::pair<Vec3, Vec3> momenta(int first, int second) const {
    Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
    for (const int i : {first, second}) {
      const dynamics::WorkBody& w = work.bodies[static_cast<std::size_t>(i)];
      const body::Shape& shape = *scene.bodies[static_cast<std::size_t>(i)].shape;
      const Vec3 way = shape.mass * (w.end.translation - w.start.translation);
      const Quat& q = w.start.rotation;
      linear += way;
      angular += w.start.translation.cross(way) +
                 q * (shape.inertia * (q.conjugate() * dynamics::turn_between(q, w.end.rotation)));
    }
    return {linear, angular};
  }

  /// How far two bodies are from where they were, seen from each other.
  double shift_between(int first, int second) const {
    const auto& a = work.bodies[static_cast<std::size_t>(first)];
    const auto& b = work.bodies[static_cast<std::size_t>(second)];
    const Vec3 before = a.start.apply_inverse(b.start.translation),
               after = a.end.apply_inverse(b.end.translation);
    const Quat turned = (a.start.rotation.conjugate() * b.start.rotation).conjugate() *
                        (a.end.rotation.conjugate() * b.end.rotation);
    return (after - before).norm() + turned.vec().norm();
  }
};

}  // namespace

TEST_CASE("a zone goes as one, with the momenta of its bodies' ways") {
  Flight flight;
  const auto before = flight.momenta(1, 2);
  const Pose third = flight.work.bodies[3].end;
  ImpactZones zones(flight.work);
  CHECK(zones.unite(1, 2));
  CHECK_FALSE(zones.unite(2, 1));
  CHECK_FALSE(zones.unite(0, 1));  // the floor does not move
  CHECK(zones.are_one(1, 2));
  CHECK_FALSE(zones.are_one(0, 1));
  CHECK_FALSE(zones.are_one(3, 3));
  CHECK(flight.shift_between(1, 2) > 1e-3);
  CHECK(zones.go() == std::vector<char>{0, 1, 1, 0});
  CHECK(flight.shift_between(1, 2) < 1e-14);
  const auto after = flight.momenta(1, 2);
  CHECK((after.first - before.first).norm() < 1e-14);
  // To second order in the turn, 0.02: centres go straight on arcs.
  CHECK((after.second - before.second).norm() < 2e-3 * before.second.norm());
  CHECK(flight.work.bodies[3].end.translation == third.translation);
  CHECK(zones.share(1) == 1.0);
}

TEST_CASE("a zone that is held up goes a part of its way, as one still, and takes nobody in") {
  Flight flight;
  ImpactZones zones(flight.work);
  zones.unite(1, 2);
  zones.go();
  const Vec3 way = flight.work.bodies[1].end.translation - flight.work.bodies[1].start.translation;
  zones.limit(2, 0.5);
  zones.go();
  CHECK(zones.share(1) == 0.5);
  CHECK(flight.shift_between(1, 2) < 1e-14);
  const Vec3 half = flight.work.bodies[1].end.translation - flight.work.bodies[1].start.translation;
  CHECK((half - 0.5 * way).norm() < 5e-3 * way.norm());
  CHECK_FALSE(zones.unite(2, 3));
  zones.limit(1, 0.0);
  zones.limit(3, 0.0);
  CHECK(zones.go() == std::vector<char>{0, 1, 1, 1});
  for (const std::size_t i : {1, 2, 3}) {
    CHECK(flight.work.bodies[i].end.translation == flight.work.bodies[i].start.translation);
    CHECK(flight.work.bodies[i].end.rotation.coeffs() == flight.work.bodies[i].start.rotation.coeffs());
  }
}

TEST_CASE(
    "gaps open by wholes: a zone gives way by the mass of all its bodies, one that was held up not at all") {
  Flight flight;
  ImpactZones zones(flight.work);
  zones.unite(1, 2);
  zones.go();
  dynamics::Opening opening;  // from the third box, through both centres
  opening.a = 3;
  opening.b = 2;
  opening.normal = Vec3::UnitY();
  opening.gap = 0.0;
  opening.wanted = 1e-4;
  const auto mass = [&](std::size_t i) { return flight.scene.bodies[i].shape->mass; };
  const Vec3 end_1 = flight.work.bodies[1].end.translation, end_2 = flight.work.bodies[2].end.translation;
  const Vec3 centre = (mass(1) * end_1 + mass(2) * end_2) / (mass(1) + mass(2));
  opening.arm_a = Vec3::Zero();
  opening.arm_b = centre - end_2;
  std::vector<dynamics::Opening> openings{opening};
  const Vec3 end_3 = flight.work.bodies[3].end.translation;
  const std::vector<dynamics::EndMove> moves = zones.open(openings, 1.0 / 240.0);
  CHECK(moves[0].is_none());
  CHECK(openings[0].impulse > 0.0);
  const double up = flight.work.bodies[3].end.translation.y() - end_3.y();
  const double down = end_1.y() - flight.work.bodies[1].end.translation.y();
  CHECK(up + down == Approx(1e-4));
  CHECK(moves[1].shift.y() == Approx(-down));
  CHECK((moves[2].shift - (flight.work.bodies[2].end.translation - end_2)).norm() < 1e-14);
  CHECK(moves[3].shift.y() == Approx(up));
  CHECK(dynamics::move_between(moves[1], moves[3]) >= up + down);
  CHECK(dynamics::move_between(moves[1], moves[3]) < 1e-3);
  CHECK(up * mass(3) == Approx(down * (mass(1) + mass(2))));
  CHECK(flight.shift_between(1, 2) < 1e-14);

  zones.limit(1, 0.9);
  zones.go();
  openings = {opening};
  const std::vector<dynamics::EndMove> again = zones.open(openings, 1.0 / 240.0);
  CHECK(again[1].is_none());
  CHECK(again[2].is_none());
  CHECK_FALSE(again[3].is_none());
}

TEST_CASE("sheets that spin together, a thousandth of a millimetre apart, are not in each other's way") {
  test::Scene scene;
  scene.settings.gravity.setZero();
  scene.settings.has_sleep = false;
  scene.settings.time_step = 1.0 / 960.0;
  const Vec3 spin(25.0, 0.0, 3.0);
  for (const double height : {0.0, 1e-6}) {
    body::Body sheet = test::make_shell(test::square_mesh(0.1, 2));
    sheet.pose.translation += Vec3(4.0, height, 0.0);
    sheet.angular_velocity = spin;
    sheet.velocity = Vec3(8.0, 0.0, 0.0) + spin.cross(Vec3(0.0, height, 0.0));
    scene.add(sheet);
  }
  for (int i = 0; i < 96; ++i) {
    scene.step();
    CHECK(scene.report.failsafe_steps == 0);
    CHECK(scene.report.crossing_pairs == 0);
  }
  CHECK(test::count_crossings(scene) == 0);
  for (const body::Body& body : scene.bodies) {
    CHECK((body.velocity - Vec3(8.0, 0.0, 0.0)).norm() < 1e-3);
    CHECK(body.angular_velocity.norm() == Approx(spin.norm()).epsilon(0.01));
  }
}

}  // namespace shatterbox
