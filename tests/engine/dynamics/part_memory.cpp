// A part that is taken again: what was not changed comes to the same, from memory, and to the same bits as
// without one.
#include "engine/dynamics/part_memory.h"

#include <catch2/catch.hpp>

#include "engine/core/parallel.h"
#include "tests/engine/dynamics/piles.h"
#include "tests/support/sanitized.h"

namespace shatterbox {
namespace {

using dynamics::StepPart;

struct Taken {
  std::uint64_t hash = 0;
  int searched = 0, recalled = 0;  // pairs whose features were listed, and of them those listed before
  int hits = 0, cut = 0;
};

/// Boats that fall on each other, some of them turning far.
test::Scene lively_scene(bool has_caches) {
  auto scene = test::boats_scene(30, 3);
  scene.settings.has_caches = has_caches;
  for (int i = 0; i < 45; ++i) scene.step();
  for (std::size_t i = 5; i < scene.bodies.size(); i += 4)
    scene.bodies[i].angular_velocity += Vec3(300.0, 0.0, 100.0);
  for (std::size_t i = 6; i < scene.bodies.size(); i += 4) scene.bodies[i].velocity += Vec3(8.0, -9.0, 3.0);
  return scene;
}

/// One part of a step of these, then the same again after `change` was made.
template <class Change>
Taken take_twice(bool has_caches, const Change& change) {
  auto scene = lively_scene(has_caches);
  const test::Scene before = scene;
  dynamics::move_part(scene.bodies, scene.settings, {0, 2, true, false}, scene.state, scene.log);
  scene = before;
  change(scene.bodies);
  const auto report =
      dynamics::move_part(scene.bodies, scene.settings, {0, 2, true, true}, scene.state, scene.log);
  Taken taken{scene.hash(), 0, 0, report.hits, report.failsafe_steps};
  const dynamics::SearchShelf& shelf = *scene.state.shelf;
  for (const auto& pair : shelf.part.pairs) {
    taken.searched += pair.gaps ? 1 : 0;
    for (const auto& former : shelf.former.pairs) {
      if (former.body_a != pair.body_a || former.body_b != pair.body_b) continue;
      taken.recalled += pair.gaps && pair.gaps == former.gaps ? 1 : 0;
    }
  }
  return taken;
}

TEST_CASE("a part that is taken again with another body comes to the bits that it has without memory") {
  const std::size_t changed = GENERATE(std::size_t{10}, std::size_t{17}, std::size_t{20});
  if (test::kIsSanitized && changed != 17) return;
  const auto push = [&](std::vector<body::Body>& bodies) {
    bodies[changed].velocity += Vec3(2.0, -9.0, -3.0);
  };
  const Taken expected = take_twice(false, push);
  CHECK(expected.hits > 0);
  CHECK(expected.recalled == 0);
  for (const int threads : {1, 3}) {
    core::set_thread_count(threads);
    const Taken taken = take_twice(true, push);
    CHECK(taken.hash == expected.hash);
    CHECK(taken.hits == expected.hits);
    CHECK(taken.cut == expected.cut);
    // Most pairs are of others.
    CHECK(2 * taken.recalled > taken.searched);
    CHECK(taken.recalled < taken.searched);
  }
  core::set_thread_count(0);
}

TEST_CASE("a part that is taken again without a body, or with a new one, forgets only what was theirs") {
  const auto replace = [](std::vector<body::Body>& bodies) {
    body::Body born = bodies[12];
    born.id = bodies.back().id + 1;
    born.velocity += Vec3(0.0, 0.2, 0.0);
    bodies.erase(bodies.begin() + 12);
    bodies.push_back(born);
  };
  const Taken expected = take_twice(false, replace), taken = take_twice(true, replace);
  CHECK(taken.hash == expected.hash);
  CHECK(taken.recalled > 0);
}

/// What those who judge hits look at.
std::vector<Vec3> judged_impulses(const body::ImpulseLog& log) {
  std::vector<Vec3> impulses;
  for (const body::LoggedImpulse& entry : log) {
    if (entry.kind == body::ImpulseKind::collision || entry.kind == body::ImpulseKind::contact)
      impulses.push_back(entry.impulse_world);
  }
  return impulses;
}

TEST_CASE("a trial tells the hits of a part, which then comes to the bits that it has without one") {
  const test::Scene before = lively_scene(true);
  test::Scene whole = before;
  const auto take = [](test::Scene& scene, bool is_again, bool is_trial) {
    scene.log.clear();
    return dynamics::move_part(scene.bodies, scene.settings, {0, 2, true, is_again, is_trial}, scene.state,
                               scene.log);
  };
  CHECK(!take(whole, false, false).is_unfinished);
  test::Scene tried = before;
  CHECK(take(tried, false, true).is_unfinished);
  CHECK(judged_impulses(tried.log) == judged_impulses(whole.log));
  const test::Scene left = tried;
  tried = before;
  CHECK(!take(tried, true, false).is_unfinished);
  CHECK(tried.hash() == whole.hash());
  CHECK(left.hash() != whole.hash());
}

TEST_CASE("a trial of a part whose ways are free is the part") {
  test::Scene whole = test::boats_scene(4, 3), tried = whole;
  dynamics::move_part(whole.bodies, whole.settings, {0, 1, true}, whole.state, whole.log);
  const auto report =
      dynamics::move_part(tried.bodies, tried.settings, {0, 1, true, false, true}, tried.state, tried.log);
  CHECK(!report.is_unfinished);
  CHECK(tried.hash() == whole.hash());
}

TEST_CASE("what is not said to come from the same beginning remembers nothing") {
  auto scene = test::boats_scene(10, 3);
  for (int i = 0; i < 40; ++i) scene.step();
  CHECK(scene.state.shelf->part.pairs.empty());
  dynamics::move_part(scene.bodies, scene.settings, {0, 1, true, false}, scene.state, scene.log);
  CHECK(!scene.state.shelf->part.pairs.empty());
  dynamics::move_part(scene.bodies, scene.settings, {0, 1, true, false}, scene.state, scene.log);
  CHECK(scene.state.shelf->former.pairs.empty());
}

}  // namespace
}  // namespace shatterbox
