// A small, a large and a stiff twin of one scene break the same way. Lengths go as L and times with them, at
// the same density, speeds and stresses: gravity goes as 1 / L, the energy of cracks as L. What is k^2 times
// as stiff and as strong is k times as quick, with k^2 times the gravity and the energy of cracks. L and k
// are powers of two.
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <string>

#include "engine/geometry/generators.h"
#include "engine/world/world.h"
#include "tests/engine/world/held_pane.h"
#include "tests/support/sanitized.h"

using namespace shatterbox;

namespace {

/// What a twin is of the scene: its lengths and its speeds, each as a factor.
struct Twin {
  const char* name;
  double length, speed;
};

constexpr Twin kItself{"itself", 1.0, 1.0};
constexpr Twin kTwins[] = {{"small", 1.0 / 1024.0, 1.0}, {"large", 1024.0, 1.0}, {"stiff", 1.0, 16.0}};

constexpr int kTwinRate = 1024;  // steps a second of the scene itself: the large twin's are a second
constexpr double kTwinYoung = 1e12 / (16.0 * 16.0);  // Pa, of what breaks: the stiff twin's are 1e12
constexpr double kTwinGravity = 9.81;                // m/s2

material::Material twin_of(const char* preset, double young, const Twin& twin) {
  material::Material m = *material::find_preset(preset);
  const double stress = twin.speed * twin.speed;
  m.young = young * stress;
  m.strength *= stress;
  m.yield *= stress;
  m.fracture_energy *= stress * twin.length;
  m.flaw_area *= twin.length * twin.length;
  return m;
}

geometry::TriangleMesh scaled(geometry::TriangleMesh mesh, double factor) {
  for (Vec3& p : mesh.positions) p *= factor;
  return mesh;
}

/// A slab of plaster 6 cm thick, long and free: it snaps into few pieces. How far cracks of a wide one come
/// rounding alone can decide.
world::BodyDescription make_twin_slab(const Twin& twin) {
  world::SolidDescription solid;
  solid.mesh = scaled(geometry::make_box_surface(Vec3(0.2, 0.06, 0.03)), twin.length);
  solid.element_size = 0.04 * twin.length;
  world::BodyDescription body;
  body.form = solid;
  return body;
}

world::BodyDescription make_twin_pane(const Twin& twin) {
  world::ShellDescription shell = test::held_pane(0.4, 4e-3 * twin.length);
  shell.mesh = scaled(shell.mesh, twin.length);
  world::BodyDescription body;
  body.form = shell;
  return body;
}

struct FirstBreak {
  double ratio = 0.0;  // stress over strength of the hit
  world::BreakRow row;
};

/// A ball of steel meets what lies or stands there.
FirstBreak break_first(const world::BodyDescription& what, const char* preset, double speed, const Twin& twin,
                       std::uint64_t seed) {
  world::WorldSettings settings;
  settings.seed = seed;
  settings.steps_per_second = static_cast<int>(kTwinRate * twin.speed / twin.length);
  settings.gravity = Vec3(0.0, -kTwinGravity * twin.speed * twin.speed / twin.length, 0.0);
  world::World w(settings);
  REQUIRE(w.add_material(twin_of(preset, kTwinYoung, twin)).ok());
  const auto steel = w.add_material(twin_of("steel", 64.0 * kTwinYoung, twin));
  REQUIRE(steel.ok());
  REQUIRE(w.add_body(what).ok());
  world::BodyDescription ball;
  ball.form = world::SphereDescription{0.03 * twin.length};
  ball.material = steel.value();
  ball.pose.translation = twin.length * Vec3(0.03, 0.01, 0.08);
  ball.velocity = Vec3(0.0, 0.0, -speed * twin.speed);
  REQUIRE(w.add_body(ball).ok());
  for (int i = 0; i < 64 && w.report().breaks.empty(); ++i) w.step();
  REQUIRE_FALSE(w.report().breaks.empty());
  FirstBreak first;
  first.row = w.report().breaks[0];
  for (const world::ImpactRow& row : w.report().impacts)
    if (first.ratio == 0.0 && row.verdict.starts_with("broke")) first.ratio = row.ratio;
  // As of the scene itself.
  first.row.time *= twin.speed / twin.length;
  first.row.place /= twin.length;
  first.row.new_area /= std::pow(twin.length, 2);
  first.row.elastic_energy /= std::pow(twin.length, 3) * std::pow(twin.speed, 2);
  return first;
}

/// What must not depend on the twin by more than rounding.
void check_same_hit(const FirstBreak& a, const FirstBreak& b) {
  CHECK(b.ratio > 1.0);
  CHECK(a.ratio == Approx(b.ratio).epsilon(1e-9));
  CHECK(a.row.time == Approx(b.row.time).epsilon(1e-12));
  CHECK((a.row.place - b.row.place).norm() < 1e-9);
  CHECK(a.row.elastic_energy == Approx(b.row.elastic_energy).epsilon(1e-9));
}

}  // namespace

TEST_CASE("a small and a large and a stiff twin of a plaster slab break the same way") {
  struct Sum {
    double pieces = 0.0, area = 0.0;
  };
  Sum expected;
  std::map<std::string, Sum> sums;
  for (int seed = 1; seed <= test::how_many(4, 1); ++seed) {
    const auto first = [&](const Twin& t) {
      return break_first(make_twin_slab(t), "plaster", 6.0, t, static_cast<std::uint64_t>(seed));
    };
    const FirstBreak itself = first(kItself);
    expected.pieces += itself.row.pieces;
    expected.area += itself.row.new_area;
    for (const Twin& twin : kTwins) {
      CAPTURE(twin.name, seed);
      const FirstBreak other = first(twin);
      check_same_hit(other, itself);
      sums[twin.name].pieces += other.row.pieces;
      sums[twin.name].area += other.row.new_area;
    }
  }
  for (const auto& [name, sum] : sums) {
    CAPTURE(name);
    CHECK(sum.pieces < 1.4 * expected.pieces);
    CHECK(expected.pieces < 1.4 * sum.pieces);
    CHECK(sum.area == Approx(expected.area).epsilon(0.25));
  }
}

TEST_CASE("a small and a large and a stiff twin of a glass pane break into the same pieces") {
  const auto first = [](const Twin& t) { return break_first(make_twin_pane(t), "glass", 8.0, t, 1); };
  const FirstBreak itself = first(kItself);
  CHECK(itself.row.pieces > 5);
  for (const Twin& twin : kTwins) {
    CAPTURE(twin.name);
    const FirstBreak other = first(twin);
    check_same_hit(other, itself);
    CHECK(other.row.pieces == itself.row.pieces);
    CHECK(other.row.new_area == Approx(itself.row.new_area).epsilon(1e-12));
  }
}
