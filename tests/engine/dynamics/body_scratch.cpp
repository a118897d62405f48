// Memory that bodies write their places into: it goes from step to step, and what was written before tells
// nothing.
#include "engine/dynamics/body_scratch.h"

#include <catch2/catch.hpp>

#include <map>

#include "tests/engine/dynamics/piles.h"

namespace shatterbox {
namespace {

/// Boats that fall on each other; then one is gone, another is a box, and they go on.
std::uint64_t fall_and_change(bool keeps_scratch) {
  auto scene = test::boats_scene(12, 3);
  const auto go_on = [&](int steps) {
    for (int i = 0; i < steps; ++i) {
      scene.step();
      if (!keeps_scratch) scene.state.shelf->scratch.clear();
    }
  };
  go_on(60);
  scene.bodies.erase(scene.bodies.begin() + 4);
  body::Body& changed = scene.bodies[6];
  changed.shape = test::make_box(Vec3(0.02, 0.01, 0.03), Vec3::Zero()).shape;
  go_on(20);
  return scene.hash();
}

TEST_CASE("what a part of a step wrote before tells the next one nothing") {
  CHECK(fall_and_change(true) == fall_and_change(false));
}

TEST_CASE("bodies write their places where they wrote them in the step before") {
  auto scene = test::boats_scene(12, 3);
  for (int i = 0; i < 60; ++i) scene.step();
  std::map<body::BodyId, const Vec3*> before;
  for (const auto& own : scene.state.shelf->scratch) before[own.id] = own.placed.start.data();
  scene.step();
  int known = 0;
  for (const auto& own : scene.state.shelf->scratch) {
    if (!before.count(own.id)) continue;
    CHECK(before[own.id] == own.placed.start.data());
    ++known;
  }
  CHECK(known > 10);
}

}  // namespace
}  // namespace shatterbox
