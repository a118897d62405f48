// Stiff and extreme cases through the door, each with the answer that theory gives. tests/README.md lists
// them all.
#include <catch2/catch.hpp>
#include <cmath>

#include "engine/audit/audit.h"
#include "engine/geometry/generators.h"
#include "engine/world/world.h"
#include "tests/support/sanitized.h"

using namespace shatterbox;

namespace {

constexpr double kKeptGap = 5e-4;  // share of the size

world::World make_world(world::WorldSettings settings, double friction = 0.5, double restitution = 0.0) {
  world::World w(settings);
  material::Material material;
  material.friction = friction;
  material.restitution = restitution;
  REQUIRE(w.add_material(material).ok());
  return w;
}

body::BodyId add(world::World& w, const world::BodyDescription& description) {
  const auto id = w.add_body(description);
  REQUIRE(id.ok());
  return id.value();
}

world::BodyDescription plane(const Vec3& place = Vec3::Zero()) {
  world::BodyDescription floor;
  floor.form = world::PlaneDescription{};
  floor.pose.translation = place;
  return floor;
}

world::BodyDescription box(double half, const Vec3& place, double density = 2500.0) {
  world::BodyDescription body;
  body.form = world::BoxDescription{Vec3::Constant(half)};
  body.pose.translation = place;
  body.density = density;
  return body;
}

world::BodyDescription ball(double radius, const Vec3& place, double density = 2500.0) {
  world::BodyDescription body;
  body.form = world::SphereDescription{radius};
  body.pose.translation = place;
  body.density = density;
  return body;
}

world::BodyDescription shell(const geometry::TriangleMesh& mesh, const Vec3& place, double thickness) {
  world::BodyDescription body;
  world::ShellDescription form;
  form.mesh = mesh;
  form.thickness = thickness;
  form.is_breakable = false;
  body.form = form;
  body.pose.translation = place;
  return body;
}

geometry::TriangleMesh sphere_mesh(double radius, double edge) {
  geometry::Meshing meshing;
  meshing.edge_length = edge;
  return geometry::make_sphere(radius, meshing).value();
}

double energy(const world::World& w) {
  double sum = 0.0;
  for (const body::Body& b : w.bodies()) {
    sum += body::kinetic_energy(b);
    if (b.is_dynamic()) sum -= b.shape->mass * w.settings().gravity.dot(b.pose.translation);
  }
  return sum;
}

void run(world::World& w, double seconds) {
  const long last = w.steps() + std::lround(seconds * w.settings().steps_per_second);
  while (w.steps() < last) w.step();
}

/// A stack of three boxes and a ball that is thrown at it, all lengths times `scale` with gravity, about
/// `origin`.
std::vector<Vec3> played_at(double scale, const Vec3& origin) {
  world::WorldSettings settings;
  settings.gravity *= scale;
  settings.has_sleep = false;
  auto w = make_world(settings);
  add(w, plane(origin));
  for (int k = 0; k < 3; ++k) add(w, box(0.1 * scale, origin + scale * Vec3(0.0, 0.1002 + 0.2003 * k, 0.0)));
  auto shot = ball(0.05 * scale, origin + scale * Vec3(-1.0, 0.45, 0.01));
  shot.velocity = scale * Vec3(4.0, 1.0, 0.0);
  add(w, shot);
  run(w, 0.5);
  std::vector<Vec3> places;
  for (const body::Body& b : w.bodies()) places.push_back((b.pose.translation - origin) / scale);
  return places;
}

}  // namespace

TEST_CASE("Young's modulus from 1e3 to 1e13 Pa: duration and stress go with its root") {
  std::vector<double> durations, stresses;
  for (int power = 3; power <= 13; power += 2) {
    world::WorldSettings settings;
    settings.gravity.setZero();
    world::World w(settings);
    material::Material material = *material::find_preset("glass");
    material.young = std::pow(10.0, power);
    material.strength = 6e7 * std::pow(material.young / 70e9, 0.45);  // it holds, and not by far
    REQUIRE(w.add_material(material).ok());
    add(w, plane());
    auto hollow = shell(sphere_mesh(0.04, 0.008), Vec3(0.0, 0.05, 0.0), 5e-4);
    std::get<world::ShellDescription>(hollow.form).is_breakable = true;
    hollow.velocity = Vec3(0.0, -1.2, 0.0);
    add(w, hollow);
    run(w, 0.1);
    REQUIRE(w.report().breaks.empty());
    REQUIRE_FALSE(w.report().impacts.empty());
    const world::ImpactRow& row = w.report().impacts[0];
    CAPTURE(power, row.verdict);
    REQUIRE(row.duration > 0.0);
    REQUIRE(row.ratio > 0.0);
    durations.push_back(row.duration);
    stresses.push_back(row.stress);
  }
  CAPTURE(durations, stresses);
  // A spring's duration goes as E^-1/2, Hertz' as E^-2/5; the force as their inverse. At 1e3 Pa the ball is
  // pressed flat: its patch is as large as it may be, which changes the stress of a force.
  for (std::size_t i = 0; i + 1 < durations.size(); ++i) {
    const double margin = i == 0 ? 0.2 : 0.1;
    CHECK(std::log10(durations[i] / durations[i + 1]) / 2.0 == Approx(0.45).margin(margin));
    CHECK(std::log10(stresses[i + 1] / stresses[i]) / 2.0 == Approx(0.45).margin(margin));
  }
}

TEST_CASE("a scene of a tenth of a millimetre or ten kilometres is the same scene") {
  const auto metre = played_at(1.0, Vec3::Zero());
  CHECK((metre.back() - Vec3(-1.0, 0.45, 0.01)).norm() > 0.3);  // it hit
  for (const double scale : {1e-4, 1e-2, 1e2, 1e4}) {
    const auto scaled = played_at(scale, Vec3::Zero());
    for (std::size_t i = 0; i < metre.size(); ++i) {
      CAPTURE(scale, i);
      CHECK((scaled[i] - metre[i]).norm() < 1e-6);
    }
  }
}

TEST_CASE("a scene 1e5 m from the origin is the same scene") {
  const auto here = played_at(1.0, Vec3::Zero());
  const auto there = played_at(1.0, Vec3(1e5, -1e5, 1e5));
  for (std::size_t i = 0; i < here.size(); ++i) {
    CAPTURE(i);
    CHECK((there[i] - here[i]).norm() < 1e-4);  // of boxes of 0.2 m
  }
}

TEST_CASE("collisions of masses a million times apart keep momentum and Newton's rule") {
  for (const double ratio : {1e2, 1e4, 1e6})
    for (const double restitution : {0.0, 0.5, 1.0}) {
      world::WorldSettings settings;
      settings.gravity.setZero();
      auto w = make_world(settings, 0.0, restitution);
      auto light = ball(0.1, Vec3(-0.5, 0.0, 0.0), 1000.0), heavy = ball(0.1, Vec3::Zero(), 1000.0 * ratio);
      light.velocity = Vec3(3.0, 0.0, 0.0);
      add(w, light);
      add(w, heavy);
      run(w, 0.5);
      const double share = 1.0 / (1.0 + ratio);
      CAPTURE(ratio, restitution);
      CHECK(w.bodies()[1].velocity.x() == Approx(3.0 * share * (1.0 + restitution)).epsilon(1e-9));
      CHECK(w.bodies()[0].velocity.x() ==
            Approx(3.0 * (1.0 - (1.0 - share) * (1.0 + restitution))).epsilon(1e-9).margin(1e-9));
    }
}

// The limit: beyond it scenes are told at load (sandbox/scene/limits.h).
TEST_CASE("a box carries one of ten thousand times its mass") {
  // The greater one takes ten thousand sweeps: two minutes under the sanitizers.
  for (const double ratio : test::kIsSanitized ? std::vector{1e2} : std::vector{1e2, 1e4}) {
    world::WorldSettings settings;
    settings.has_sleep = false;
    auto w = make_world(settings);
    add(w, plane());
    const double gap = kKeptGap * 2.0 * 0.1 * std::sqrt(3.0);
    add(w, box(0.1, Vec3(0.0, 0.1 + gap, 0.0), 1000.0));
    add(w, box(0.1, Vec3(0.0, 0.3 + 2.0 * gap, 0.0), 1000.0 * ratio));
    run(w, 1.0);
    double below = 0.0, between = 0.0;
    for (int i = 0; i < 60; ++i) {
      w.step();
      for (const body::LoggedImpulse& entry : w.impulse_log()) {
        const double up = std::abs(entry.impulse_world.y());
        (std::min(entry.body_a, entry.body_b) == 1 ? below : between) += up;
      }
    }
    const double weight = 8.0 * 9.81 * 60.0 / 240.0;  // of the light one, N s
    CAPTURE(ratio);
    CHECK(between == Approx(weight * ratio).epsilon(1e-3));
    CHECK(below == Approx(weight * (ratio + 1.0)).epsilon(1e-3));
    CHECK(w.bodies()[2].pose.translation.y() == Approx(0.3 + 2.0 * gap).epsilon(1e-3));
  }
}

TEST_CASE("1000 m/s at 60 steps a second: nothing passes and no energy is gained") {
  for (const double speed : {10.0, 100.0, 1000.0}) {
    world::WorldSettings settings;
    settings.steps_per_second = 60;
    settings.gravity.setZero();
    auto w = make_world(settings, 0.3, 0.3);
    geometry::Meshing meshing;
    meshing.edge_length = 0.1;
    add(w, shell(geometry::make_pane(1.0, 1.0, meshing).value(), Vec3::Zero(), 1e-3));
    auto hollow = shell(sphere_mesh(0.1, 0.05), Vec3(0.05, 0.03, 0.4 + 0.3 * speed / 60.0), 1e-3);
    hollow.velocity = Vec3(0.0, 0.0, -speed);
    add(w, hollow);
    auto solid = ball(0.05, Vec3(-0.2, -0.1, 0.6 + 1.7 * speed / 60.0));
    solid.velocity = Vec3(0.1 * speed, 0.0, -speed);
    add(w, solid);
    w.keep_ways();
    const double start = energy(w);
    Vec3 momentum = Vec3::Zero();
    for (const body::Body& b : w.bodies()) momentum += b.shape->mass * b.velocity;
    audit::Audit audit;
    for (int i = 0; i < 6; ++i) {
      audit.begin_step(w.bodies());
      w.step();
      audit.end_step(w.bodies(), {}, w.ways(), w.time());
      CHECK(energy(w) <= start * (1.0 + 1e-9));
    }
    CAPTURE(speed);
    CHECK(audit.report().crossings == 0);
    CHECK(audit.report().passages == 0);
    Vec3 after = Vec3::Zero();
    for (const body::Body& b : w.bodies()) after += b.shape->mass * b.velocity;
    CHECK((after - momentum).norm() < 1e-9 * momentum.norm());
    CHECK(w.bodies()[0].velocity.z() < -1e-3 * speed);  // it was hit
  }
}

TEST_CASE("without gravity and with a thousand times it a stack stands and carries its weight") {
  for (const double g : {0.0, 9.81, 9810.0}) {
    world::WorldSettings settings;
    // As far as a body falls in a step of its own size: fewer, and it creeps (sandbox/scene/limits.h).
    settings.steps_per_second = g > 1000.0 ? 3840 : 240;
    settings.gravity = Vec3(0.0, -g, 0.0);
    settings.has_sleep = false;
    auto w = make_world(settings);
    add(w, plane());
    const double gap = kKeptGap * 0.2 * std::sqrt(3.0);
    for (int k = 0; k < 3; ++k) add(w, box(0.1, Vec3(0.0, 0.1 + gap + (0.2 + gap) * k, 0.0)));
    const int steps = settings.steps_per_second / static_cast<int>(test::how_many(1, 8));
    for (int i = 0; i < steps; ++i) w.step();
    double below = 0.0;
    for (int i = 0; i < steps; ++i) {
      w.step();
      for (const body::LoggedImpulse& entry : w.impulse_log())
        if (std::min(entry.body_a, entry.body_b) == 1) below += std::abs(entry.impulse_world.y());
    }
    CAPTURE(g);
    CHECK(below == Approx(3.0 * 20.0 * g * steps / settings.steps_per_second).epsilon(1e-4).margin(1e-12));
    for (int k = 0; k < 3; ++k)
      CHECK((w.bodies()[static_cast<std::size_t>(k + 1)].pose.translation -
             Vec3(0.0, 0.1 + gap + (0.2 + gap) * k, 0.0))
                .norm() < 1e-3);
  }
}

namespace {

/// How far a box on the floor and a bowl of shell moved in that many steps, m, from a second on.
double drift_at_rest(long steps) {
  world::WorldSettings settings;
  settings.has_sleep = false;
  auto w = make_world(settings);
  add(w, plane());
  add(w, box(0.1, Vec3(0.0, 0.1002, 0.0)));
  geometry::Meshing meshing;
  meshing.edge_length = 0.03;
  add(w, shell(geometry::make_bowl(geometry::BowlSizes{}, meshing).value(), Vec3(0.5, 1e-4, 0.0), 2e-3));
  run(w, 1.0);
  const std::vector<body::Body> before(w.bodies().begin(), w.bodies().end());
  for (long i = 0; i < steps; ++i) w.step();
  double moved = 0.0;
  for (std::size_t i = 0; i < before.size(); ++i)
    moved = std::max(moved, (w.bodies()[i].pose.translation - before[i].pose.translation).norm());
  return moved;
}

}  // namespace

TEST_CASE("twenty thousand steps at rest with sleep off") {
  CHECK(drift_at_rest(test::how_many(20000, 2000)) < 1e-6);
}

TEST_CASE("a million steps at rest with sleep off", "[.][long]") {
  CHECK(drift_at_rest(1000000) < 1e-6);
}

TEST_CASE("ten thousand bodies fall and each bears its own weight") {
  const int side = static_cast<int>(test::how_many(100, 20));
  world::WorldSettings settings;
  settings.has_sleep = false;
  auto w = make_world(settings);
  add(w, plane());
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j)
      add(w, ball(0.05, Vec3(0.11 * i, 0.05 * (1.0 + 2.0 * kKeptGap), 0.11 * j)));
  run(w, 10.0 / 240.0);
  double up = 0.0, mass = 0.0;
  w.step();
  for (const body::LoggedImpulse& entry : w.impulse_log()) up += std::abs(entry.impulse_world.y());
  for (const body::Body& b : w.bodies()) {
    if (!b.is_dynamic()) continue;
    mass += b.shape->mass;
    CHECK(b.pose.translation.y() == Approx(0.05 * (1.0 + 2.0 * kKeptGap)).epsilon(1e-4));
  }
  CHECK(up == Approx(mass * 9.81 / 240.0).epsilon(1e-4));
}

TEST_CASE("a body of one triangle falls and comes to rest above the floor") {
  world::WorldSettings settings;
  settings.has_sleep = false;
  auto w = make_world(settings, 0.5, 0.3);
  add(w, plane());
  geometry::TriangleMesh mesh;
  mesh.positions = {Vec3(0, 0, 0), Vec3(0.2, 0, 0.02), Vec3(0.05, 0.1, 0.13)};
  mesh.triangles = {{0, 1, 2}};
  auto triangle = shell(mesh, Vec3(0.0, 0.4, 0.0), 2e-3);
  triangle.angular_velocity = Vec3(3.0, 1.0, -2.0);
  add(w, triangle);
  const double start = energy(w);
  double most = start, speed = 1.0;
  for (int i = 0; i < 5 * 240; ++i) {
    w.step();
    most = std::max(most, energy(w));
    const body::Body& b = w.bodies()[1];
    for (const Vec3& v : b.shape->surface.positions) REQUIRE(b.pose.apply(v).y() > 0.0);
    speed = b.velocity.norm() + 0.1 * b.angular_velocity.norm();
  }
  CHECK(most <= start * (1.0 + 1e-3));
  CHECK(speed < 1e-3);
}

namespace {

/// A hollow sphere of about that many triangles dropped on the floor: it bounces to e^2 of its height.
void drop_fine_sphere(double edge) {
  world::WorldSettings settings;
  settings.steps_per_second = 960;
  auto w = make_world(settings, 0.0, 0.5);
  add(w, plane());
  const double radius = 0.1, height = 0.02, ground = radius * (1.0 + 2.0 * kKeptGap);
  auto hollow = shell(sphere_mesh(radius, edge), Vec3(0.0, ground + height, 0.0), 1e-3);
  add(w, hollow);
  double highest = 0.0, last = 0.0;
  bool has_bounced = false;
  for (int i = 0; i < 200; ++i) {
    w.step();
    const double speed = w.bodies()[1].velocity.y();
    has_bounced |= last < -0.1 && speed > 0.0;
    if (has_bounced) highest = std::max(highest, w.bodies()[1].pose.translation.y() - ground);
    last = speed;
  }
  CHECK(highest == Approx(0.25 * height).epsilon(0.05));
}

}  // namespace

TEST_CASE("a body of many triangles bounces as one of few") {
  for (const double edge : {0.02, test::kIsSanitized ? 0.006 : 0.002}) drop_fine_sphere(edge);
}

TEST_CASE("a body of a million triangles bounces as one of few", "[.][long]") {
  drop_fine_sphere(0.00054);
}
