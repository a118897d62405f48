// What rests on a breakable thing breaks it, or not, whatever the step: contact is an average over a time.
#include <catch2/catch.hpp>

#include "engine/geometry/generators.h"
#include "engine/world/world.h"
#include "tests/engine/world/held_pane.h"
#include "tests/support/sanitized.h"

using namespace shatterbox;

namespace {

/// A ball of steel at rest on the middle of a pane whose border is held; gravity bears down on it. After half
/// a second: the greatest ratio of stress to strength that the pane was found to bear, and whether it broke.
struct Rest {
  double ratio = 0.0;
  bool has_broken = false;
};

Rest rest_on_pane(int steps_per_second, double density) {
  world::WorldSettings settings;
  settings.steps_per_second = steps_per_second;
  settings.has_sleep = false;
  world::World w(settings);
  const int glass = w.add_material(*material::find_preset("glass")).value();
  const int steel = w.add_material(*material::find_preset("steel")).value();
  world::BodyDescription pane;
  pane.name = "pane";
  pane.form = test::held_pane(0.5, 3e-3);
  pane.material = glass;
  pane.pose.rotation = Quat(Eigen::AngleAxisd(-1.5707963267948966, Vec3::UnitX()));
  REQUIRE(w.add_body(pane).ok());
  world::BodyDescription ball;
  ball.form = world::SphereDescription{0.05};
  ball.material = steel;
  ball.density = density;
  ball.pose.translation = Vec3(0.0, 0.05 * (1.0 + 1e-3), 0.0);  // at the gap that is kept
  REQUIRE(w.add_body(ball).ok());
  Rest rest;
  while (w.time() < 0.5 && !rest.has_broken) {
    w.step();
    rest.has_broken = !w.report().breaks.empty();
    for (const world::ImpactRow& row : w.report().impacts) rest.ratio = std::max(rest.ratio, row.ratio);
  }
  return rest;
}

/// What can break, on two supports 90 cm from each other; what is laid on it is of their material. Their tops
/// are .2 m up.
struct Bridge {
  const char *material, *support;
  Vec3 half_extent;     // m
  double element_size;  // m
  Vec3 support_half;    // m
};
world::World build_bridge(const Bridge& bridge, const world::WorldSettings& settings) {
  world::World w(settings);
  const int material = w.add_material(*material::find_preset(bridge.material)).value();
  const int below = w.add_material(*material::find_preset(bridge.support)).value();
  for (const double x : {-0.45, 0.45}) {
    world::BodyDescription support;
    support.form = world::BoxDescription{bridge.support_half};
    support.material = below;
    support.motion = body::Motion::fixed;
    support.pose.translation = Vec3(x, 0.2 - bridge.support_half.y(), 0.0);
    REQUIRE(w.add_body(support).ok());
  }
  world::SolidDescription solid;
  solid.mesh = geometry::make_box_surface(bridge.half_extent);
  solid.is_breakable = true;
  solid.element_size = bridge.element_size;
  world::BodyDescription span;
  span.form = solid;
  span.material = material;
  span.pose.translation = Vec3(0.0, 0.2 + bridge.half_extent.y() + 1e-5, 0.0);
  REQUIRE(w.add_body(span).ok());
  return w;
}

/// Lays a block of so many kg on its middle, its foot at that height (m).
void lay_block(world::World& w, const Vec3& half_extent, double mass, double foot) {
  world::BodyDescription block;
  block.form = world::BoxDescription{half_extent};
  block.material = 1;
  block.density = mass / (8.0 * half_extent.prod());
  block.pose.translation = Vec3(0.0, foot + half_extent.y(), 0.0);
  REQUIRE(w.add_body(block).ok());
}

/// Whether a beam of concrete of 1 m comes apart in .15 s under so many kg.
bool breaks_beam(int steps_per_second, double element_size, double mass) {
  world::WorldSettings settings;
  settings.steps_per_second = steps_per_second;
  world::World w = build_bridge(
      {"concrete", "steel", Vec3(0.5, 0.05, 0.05), element_size, Vec3(0.025, 0.1, 0.1)}, settings);
  lay_block(w, Vec3(0.03, 0.03, 0.03), mass, 0.3 + 2e-5);
  const std::size_t count = w.bodies().size();
  while (w.time() < 0.15 && w.bodies().size() == count) w.step();
  return w.bodies().size() > count;
}

/// Blocks of 8 kg are laid one upon the other on a board of plaster, each when the one before has long been
/// at rest: how many when it comes apart; 0: it bears them all.
int lay_blocks(bool has_sleep, int most) {
  world::WorldSettings settings;
  settings.steps_per_second = 60;
  settings.has_sleep = has_sleep;
  world::World w =
      build_bridge({"plaster", "brick", Vec3(0.55, 0.01, 0.1), 0.02, Vec3(0.06, 0.1, 0.12)}, settings);
  for (int count = 1; count <= most; ++count) {
    lay_block(w, Vec3(0.1, 0.03, 0.05), 8.0, 0.22 + 0.06 * (count - 1) + 2e-4 * count);
    for (int step = 0; step < 60; ++step) {
      w.step();
      if (!w.report().breaks.empty()) return count;
    }
    CHECK(w.bodies()[2].sleeps() == has_sleep);
  }
  return 0;
}

}  // namespace

TEST_CASE("what is laid on a heap that sleeps is felt by what may break under it") {
  const int awake = lay_blocks(false, 12);
  CHECK(awake >= 3);
  CHECK(lay_blocks(true, 12) == awake);
}

TEST_CASE("a beam breaks under the same weight whatever its elements and the step") {
  const std::vector<double> sizes = test::kIsSanitized ? std::vector{0.05} : std::vector{0.05, 0.04, 0.025};
  for (const double size : sizes)
    for (const int rate : {60, 240}) {
      CAPTURE(size, rate);
      // The modulus of rupture of concrete so high, 1.7 times its strength in tension, says 360 kg [MC2010].
      CHECK_FALSE(breaks_beam(rate, size, 400.0));
      CHECK(breaks_beam(rate, size, 900.0));
    }
}

TEST_CASE("what rests on a pane breaks it or not whatever the step") {
  const double density = 30000.0, ratio = rest_on_pane(60, density).ratio;
  CAPTURE(ratio);
  REQUIRE(ratio > 0.1);
  REQUIRE(ratio < 1.0);
  for (const int rate : {30, 60, 100, 240, 960, 3840}) {
    CAPTURE(rate);
    // The stress is in proportion to the weight: 2 % below the strength, and 2 % above it.
    const Rest held = rest_on_pane(rate, 0.98 * density / ratio);
    CHECK_FALSE(held.has_broken);
    CHECK(held.ratio > 0.88);
    CHECK(held.ratio < 0.99);
    const Rest broken = rest_on_pane(rate, 1.02 * density / ratio);
    CHECK(broken.has_broken);
  }
}
