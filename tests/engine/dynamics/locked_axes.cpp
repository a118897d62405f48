// Bodies that cannot move along, or turn about, some of the world's axes, against closed forms.
#include <catch2/catch.hpp>
#include <cmath>

#include "engine/audit/audit.h"
#include "engine/dynamics/free_motion.h"
#include "engine/dynamics/impact_zones.h"
#include "tests/engine/dynamics/bodies.h"

namespace shatterbox {
namespace {

using body::LockedAxes;
using test::Scene;

constexpr double kGravity = 9.81;

const LockedAxes kInPlane{{false, false, true}, {true, true, false}};  // of x and y
const LockedAxes kOnAxle{{true, true, true}, {true, true, false}};     // along z
const LockedAxes kOnRail{{false, true, true}, {true, true, true}};     // along x
const LockedAxes kUpAndDown{{true, false, true}, {true, true, true}};  // a piston
const LockedAxes kHinged{{true, true, true}, {true, false, false}};    // turns about y and z

body::Body locked(body::Body b, const LockedAxes& axes) {
  b.locked = axes;
  return b;
}

/// What moved, or turned, of a body along and about its locked axes since it was at `start`.
double strayed(const body::Body& b, const Pose& start) {
  const auto taken = [](const Vec3& v, const Vec3& left) { return (v - left).norm(); };
  const Vec3 way = b.pose.translation - start.translation;
  return taken(way, b.locked.let_move(way)) + taken(b.velocity, b.locked.let_move(b.velocity)) +
         taken(b.angular_velocity, b.locked.let_turn(b.angular_velocity));
}

}  // namespace

TEST_CASE(
    "the inverse of an inertia whose turns are locked gives no spin about them and all the couple asks for "
    "about others") {
  Mat3 inertia;
  inertia << 3.0, 0.4, -0.2, 0.4, 2.0, 0.3, -0.2, 0.3, 1.0;
  const Vec3 couple(0.3, -1.0, 2.0);
  for (int bits = 0; bits < 8; ++bits) {
    LockedAxes axes;
    for (std::size_t k = 0; k < 3; ++k) axes.turns[k] = (bits >> k & 1) != 0;
    const Vec3 spin = axes.invert(inertia) * couple;
    CAPTURE(bits, spin.transpose());
    CHECK((spin - axes.let_turn(spin)).norm() == 0.0);
    CHECK(axes.let_turn(inertia * spin - couple).norm() < 1e-14);
    CHECK(axes.count_turns() == 3 - (bits & 1) - (bits >> 1 & 1) - (bits >> 2 & 1));
  }
}

TEST_CASE(
    "a top that cannot turn about one axis keeps its momentum about the others and its energy to fourth "
    "order") {
  const dynamics::PrincipalInertia inertia =
      dynamics::find_principal_inertia(Vec3(1.0, 2.0, 2.7).asDiagonal());
  const LockedAxes axes{{}, {true, false, false}};
  const auto at = [&](const Quat& rotation) {
    const Mat3 r = (rotation * inertia.body_from_axes).toRotationMatrix();
    return Mat3(r * inertia.moments.asDiagonal() * r.transpose());
  };
  double errors[2];
  for (const int refined : {0, 1}) {
    Quat rotation = dynamics::rotation_by(Vec3(0.3, -0.8, 0.5));
    Vec3 spin(0.0, 2.0, -1.5);
    const Vec3 momentum = axes.let_turn(at(rotation) * spin);
    const double energy = 0.5 * spin.dot(at(rotation) * spin);
    // Each call is one part: its turn is below a twentieth of a radian.
    const double step = 0.018 / (1 + refined);
    double most = 0.0;
    for (int i = 0; i < 1000 * (1 + refined); ++i) {
      dynamics::advance_locked_spin(inertia, axes, step, rotation, spin);
      most = std::max(most, std::abs(0.5 * spin.dot(at(rotation) * spin) / energy - 1.0));
      REQUIRE(spin.x() == 0.0);
    }
    CHECK((axes.let_turn(at(rotation) * spin) - momentum).norm() < 1e-12);
    errors[refined] = most;
  }
  CAPTURE(errors[0], errors[1]);
  CHECK(errors[0] < 1e-6);
  CHECK(errors[1] < errors[0] / 10.0);
}

TEST_CASE("what is locked along y hangs where it is and what may only go along it falls as everything does") {
  Scene scene;
  scene.settings.time_step = 1.0 / 60.0;
  scene.add(locked(test::make_box(Vec3(0.1, 0.2, 0.3), Vec3(0, 5, 0)), {{false, true, false}, {}}));
  scene.bodies[0].velocity = Vec3(1, 0, 0);
  scene.add(locked(test::make_box(Vec3(0.1, 0.2, 0.3), Vec3(9, 5, 0)), kUpAndDown));
  for (int i = 0; i < 60; ++i) scene.step();
  CHECK(scene.bodies[0].pose.translation.y() == 5.0);
  CHECK(scene.bodies[0].pose.translation.x() == Approx(1.0).epsilon(1e-12));
  CHECK(scene.bodies[1].pose.translation.y() == Approx(5.0 - 0.5 * kGravity).epsilon(1e-12));
}

TEST_CASE("a ball sets a wheel on its axle turning as momentum about the axle and restitution say") {
  for (const double restitution : {0.0, 0.5, 1.0}) {
    for (const int rate : {60, 240}) {
      Scene scene;
      scene.settings.gravity.setZero();
      scene.settings.time_step = 1.0 / rate;
      scene.add(locked(test::make_box(Vec3(0.5, 0.05, 0.05), Vec3::Zero()), kOnAxle));
      scene.add(test::make_sphere(0.05, Vec3(0.4, 0.5, 0)));
      scene.bodies[1].velocity = Vec3(0, -3, 0);
      for (body::Body& b : scene.bodies) {
        b.restitution = restitution;
        b.friction = 0.0;
      }
      const double mass = scene.bodies[1].shape->mass, inertia = scene.bodies[0].shape->inertia(2, 2);
      for (int i = 0; i < rate / 4; ++i) scene.step();
      const double spin = -3.0 * 0.4 * mass * (1.0 + restitution) / (inertia + 0.16 * mass);
      CAPTURE(restitution, rate);
      CHECK(scene.bodies[0].angular_velocity.z() == Approx(spin).epsilon(2e-3));
      CHECK(strayed(scene.bodies[0], Pose{}) == 0.0);
      // What the axle takes is no turn about it.
      CHECK(scene.spin().z() == Approx(-1.2 * mass).epsilon(2e-3));
    }
  }
}

TEST_CASE("a ball bounces off what is locked along its way as off a wall") {
  for (const double restitution : {0.0, 0.6, 1.0}) {
    Scene scene;
    scene.settings.gravity.setZero();
    scene.add(locked(test::make_box(Vec3(0.2, 0.2, 0.2), Vec3::Zero()), kUpAndDown));
    scene.add(test::make_sphere(0.05, Vec3(1.0, 0.1, 0)));
    scene.bodies[1].velocity = Vec3(-5, 0, 0);
    for (body::Body& b : scene.bodies) b.restitution = restitution;
    for (int i = 0; i < 120; ++i) scene.step();
    CAPTURE(restitution);
    CHECK(scene.bodies[1].velocity.x() == Approx(5.0 * restitution).margin(1e-9));
    CHECK(scene.bodies[0].velocity.norm() == 0.0);
    CHECK(strayed(scene.bodies[0], Pose{}) == 0.0);
  }
}

TEST_CASE("a wedge on a rail and a piston upon it go as their coordinate says") {
  // The piston slides down the wedge's face, at 45 degrees: what it falls the wedge gives way, so both speed
  // up by m g / (m + M).
  Scene scene;
  scene.add(locked(test::make_box(Vec3(0.5, 0.5, 0.2), Vec3::Zero()), kOnRail));
  scene.bodies[0].pose.rotation = dynamics::rotation_by(Vec3(0, 0, core::kPi / 4.0));
  const double edge = std::sqrt(0.5);
  // The piston's lower edge rests on the face that looks to +x and up, 0.2 m from the wedge's ridge.
  scene.add(locked(test::make_box(Vec3(0.05, 0.3, 0.1), Vec3(0.25, edge - 0.2 + 0.3 + 1e-3, 0)), kUpAndDown));
  for (body::Body& b : scene.bodies) b.friction = b.restitution = 0.0;
  const Pose wedge = scene.bodies[0].pose, piston = scene.bodies[1].pose;
  for (int i = 0; i < 60; ++i) scene.step();
  const double mass = scene.bodies[1].shape->mass, other = scene.bodies[0].shape->mass;
  const double expected = 0.25 * mass * kGravity / (mass + other);
  CHECK(scene.bodies[1].velocity.y() == Approx(-expected).epsilon(0.02));
  CHECK(scene.bodies[0].velocity.x() == Approx(-expected).epsilon(0.02));
  CHECK(strayed(scene.bodies[0], wedge) == 0.0);
  CHECK(strayed(scene.bodies[1], piston) == 0.0);
}

TEST_CASE("a heap in a plane stays in it to the last bit, loses energy and comes to rest") {
  for (const bool is_shell : {false, true}) {
    Scene scene;
    scene.settings.time_step = 1.0 / 60.0;
    scene.settings.has_ways = true;
    scene.add(test::make_plane());
    scene.add(test::make_box(Vec3(0.05, 1.0, 1.0), Vec3(-0.6, 1.0, 0), false));
    scene.add(test::make_box(Vec3(0.05, 1.0, 1.0), Vec3(0.6, 1.0, 0), false));
    std::vector<Pose> starts;
    for (int k = 0; k < 12; ++k) {
      const Vec3 place(-0.3 + 0.3 * (k % 3), 0.3 + 0.3 * (k / 3), 0.01 * (k % 2));
      body::Body b = is_shell ? test::make_shell(test::bowl_mesh(0.12, 4, 12))
                              : test::make_box(Vec3(0.1, 0.06, 0.08), Vec3::Zero());
      b.pose.translation = place;
      b.pose.rotation = dynamics::rotation_by(Vec3(0, 0, 0.4 * k));
      scene.add(locked(b, kInPlane));
      starts.push_back(scene.bodies.back().pose);
    }
    audit::Audit audit;
    double energy = scene.energy(), rise = 0.0;
    long cut = 0;
    for (int i = 0; i < 300; ++i) {
      audit.begin_step(scene.bodies);
      scene.step();
      audit.end_step(scene.bodies, {}, scene.report.ways, 0.0);
      rise = std::max(rise, scene.energy() - energy);
      energy = scene.energy();
      cut += scene.report.failsafe_steps;
    }
    CAPTURE(is_shell, rise, cut, scene.kinetic());
    for (std::size_t k = 0; k < starts.size(); ++k) {
      const body::Body& b = scene.bodies[k + 3];
      CHECK(strayed(b, starts[k]) == 0.0);
      const Quat turned = b.pose.rotation * starts[k].rotation.conjugate();
      CHECK(std::abs(turned.x()) + std::abs(turned.y()) < 1e-12);
    }
    CHECK(audit.report().crossings == 0);
    CHECK(audit.report().passages == 0);
    CHECK(rise < 1e-3 * 12 * kGravity);
    CHECK(scene.kinetic() < 1e-6);
    CHECK(cut < 30);
  }
}

TEST_CASE("a pendulum that may turn about one axis alone swings as the formula says") {
  for (const double amplitude : {0.05, 1.0}) {
    Scene scene;
    scene.settings.has_sleep = false;
    scene.add(test::make_box(Vec3(0.1, 0.1, 0.1), Vec3(0, 1, 0), false));
    const double length = 0.5;
    scene.add(locked(test::make_box(Vec3(0.03, 0.1, 0.05), Vec3(length * std::sin(amplitude),
                                                                1.0 - length * std::cos(amplitude), 0.3)),
                     kInPlane));
    scene.bodies[1].pose.rotation = dynamics::rotation_by(Vec3(0, 0, amplitude));
    // The crank pin stands out of its plane: what pulls there would turn it about x and y.
    dynamics::Joint pin;
    pin.number = 1;
    pin.body_a = 2;
    pin.body_b = 1;
    pin.is_pivot = true;
    pin.area = 1e-4;
    pin.frame_a.translation = scene.bodies[1].pose.apply_inverse(Vec3(0, 1, 0));
    scene.state.joints.push_back(pin);
    const Pose start = scene.bodies[1].pose;
    const double mass = scene.bodies[1].shape->mass,
                 inertia = scene.bodies[1].shape->inertia(2, 2) + mass * length * length;
    // Legendre's series of the period, to what is left of 1e-6.
    const double half = 0.25 * amplitude * amplitude / 4.0;
    const double more = 1.0 + half + 11.0 / 12.0 * half * half + 173.0 / 180.0 * half * half * half;
    const double period = 2.0 * core::kPi * std::sqrt(inertia / (mass * kGravity * length)) * more;
    double before = scene.bodies[1].pose.translation.x(), crossed = 0.0;
    int passes = 0;
    for (int i = 1; passes < 3 && i < 2000; ++i) {
      scene.step();
      const double now = scene.bodies[1].pose.translation.x();
      if ((before > 0.0) != (now > 0.0)) {
        crossed = (i - now / (now - before)) * scene.settings.time_step;
        ++passes;
      }
      before = now;
    }
    CAPTURE(amplitude);
    CHECK(crossed == Approx(1.25 * period).epsilon(2e-3));
    CHECK(strayed(scene.bodies[1], start) == 0.0);
  }
}

TEST_CASE("what nothing can move along the normal or across it is neither thrown nor lost") {
  // A belt drags at a piston across its way; a press comes down on a slider across its rail.
  Scene scene;
  const auto drive = [&](const Vec3& half, const Vec3& place, const Vec3& velocity) {
    body::Body& b = scene.add(test::make_box(half, place));
    b.motion = body::Motion::scripted;
    b.inverse_mass = 0.0;
    b.inverse_inertia.setZero();
    b.velocity = velocity;
  };
  drive(Vec3(5, 0.1, 1), Vec3(0, -0.1, 0), Vec3(1, 0, 0));
  scene.add(locked(test::make_box(Vec3(0.1, 0.2, 0.1), Vec3(0, 0.201, 0)), kUpAndDown));
  drive(Vec3(0.2, 0.1, 0.2), Vec3(20, 1.0, 0), Vec3(0, -1, 0));
  scene.add(locked(test::make_box(Vec3(0.1, 0.1, 0.1), Vec3(20, 0.3, 0)), kOnRail));
  scene.bodies[1].rolling_friction = scene.bodies[3].rolling_friction = 0.01;
  const Pose piston = scene.bodies[1].pose, slider = scene.bodies[3].pose;
  double borne = 0.0;
  for (int i = 0; i < 240; ++i) {
    scene.step();
    borne = 0.0;
    for (const auto& entry : scene.log)
      if (entry.body_a == 2 || entry.body_b == 2)
        borne += (entry.body_a == 2 ? 1.0 : -1.0) * entry.impulse_world.y();
  }
  CHECK(borne == Approx(scene.bodies[1].shape->mass * kGravity * scene.settings.time_step).epsilon(1e-3));
  CHECK(std::abs(scene.bodies[1].velocity.y()) < 1e-6);
  CHECK(strayed(scene.bodies[1], piston) == 0.0);
  CHECK(strayed(scene.bodies[3], slider) == 0.0);
  CHECK(scene.bodies[2].pose.translation.y() >= 0.5);
  CHECK(scene.bodies[2].pose.translation.y() < 0.52);
  CHECK(std::abs(scene.bodies[3].velocity.x()) < 1e-9);
}

TEST_CASE("bodies that go as one keep to what each of them may") {
  Scene scene;
  scene.add(locked(test::make_box(Vec3(0.1, 0.1, 0.1), Vec3(0, 1, 0)), kInPlane));
  scene.add(test::make_box(Vec3(0.1, 0.1, 0.1), Vec3(0.3, 1, 0.1)));
  scene.add(locked(test::make_box(Vec3(0.1, 0.1, 0.1), Vec3(5, 1, 0)), kHinged));
  scene.add(test::make_box(Vec3(0.1, 0.1, 0.1), Vec3(5.3, 1, 0)));
  scene.bodies[1].velocity = scene.bodies[3].velocity = Vec3(-1, 2, 3);
  scene.bodies[1].angular_velocity = Vec3(5, 1, 2);
  dynamics::MotionWork work;
  scene.fly(work);
  dynamics::ImpactZones zones(work);
  REQUIRE(zones.unite(0, 1));
  REQUIRE(zones.unite(2, 3));
  zones.go();
  for (const std::size_t i : {0u, 2u}) {
    const Vec3 way = work.bodies[i].end.translation - work.bodies[i].start.translation;
    const Vec3 turn = dynamics::turn_between(work.bodies[i].start.rotation, work.bodies[i].end.rotation);
    CHECK((way - scene.bodies[i].locked.let_move(way)).norm() == 0.0);
    CHECK((turn - scene.bodies[i].locked.let_turn(turn)).norm() < 1e-15);
  }
  CHECK((work.bodies[0].end.translation - work.bodies[0].start.translation).norm() > 1e-3);
  // A hinge that nothing moves holds whoever goes with it.
  CHECK((work.bodies[3].end.translation - work.bodies[3].start.translation).norm() < 1e-15);
}

}  // namespace shatterbox

TEST_CASE("a needle that may turn about two axes keeps its energy, however its spin about itself may grow") {
  const double length = 1.0, radius = 0.002, mass = 0.1;
  const double across = mass * length * length / 12.0, along = 0.5 * mass * radius * radius;
  const dynamics::PrincipalInertia inertia =
      dynamics::find_principal_inertia(Vec3(across, along, across).asDiagonal());
  body::LockedAxes locked;
  locked.turns = {false, true, false};
  for (const double rate : {30.0, 60.0, 240.0, 960.0})
    for (const Vec3& start : {Vec3(300, 0, 1), Vec3(60, 0, 3), Vec3(20, 0, 3)}) {
      Quat rotation = dynamics::rotation_by(Vec3(0.6, 0.2, 0.9));
      Vec3 spin = start;
      const auto inertia_now = [&] {
        const Mat3 axes = (rotation * inertia.body_from_axes).toRotationMatrix();
        return Mat3(axes * inertia.moments.asDiagonal() * axes.transpose());
      };
      const double energy = spin.dot(inertia_now() * spin);
      const Vec3 momentum = locked.let_turn(inertia_now() * spin);
      for (int step = 0; step < static_cast<int>(0.5 * rate); ++step)
        dynamics::advance_locked_spin(inertia, locked, 1.0 / rate, rotation, spin);
      INFO("rate " << rate << " spin " << start.transpose() << " ends with " << spin.transpose());
      CHECK(spin.dot(inertia_now() * spin) == Approx(energy).epsilon(1e-3));
      CHECK((locked.let_turn(inertia_now() * spin) - momentum).norm() < 1e-9 * momentum.norm());
      CHECK(spin.y() == 0.0);
    }
}
