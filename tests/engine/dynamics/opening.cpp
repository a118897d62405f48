// What is opened, and by how much: gaps are those of the ways that were tested.
#include "engine/dynamics/opening.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "engine/collision/feature_gap.h"
#include "engine/dynamics/path_test.h"
#include "tests/engine/dynamics/bodies.h"

using namespace shatterbox;

namespace {

/// A sheet on edge that turns by 0.3 rad comes down on one that lies, and turns by 0.9 rad, and so goes
/// straight in two parts.
struct Meeting {
  test::Scene scene;
  dynamics::MotionWork work;
  std::vector<dynamics::PathHit> hits;

  Meeting() {
    scene.settings.time_step = 1.0 / 60.0;
    scene.settings.gravity.setZero();
    body::Body above = test::make_shell(test::square_mesh(0.05, 2)), below = above;
    above.pose = {Quat(core::sqrt(0.5), 0, 0, core::sqrt(0.5)), Vec3(0.02, 0.085, 0.01)};
    above.velocity = Vec3(0, -3.0, 0);
    above.angular_velocity = Vec3(0, 0, 18.0);
    below.angular_velocity = Vec3(0, 0, 54.0);
    scene.add(above);
    scene.add(below);
    scene.fly(work);
    dynamics::PathTest paths(scene.settings, work);
    paths.prepare(std::vector<std::size_t>(work.pairs.size(), 0));
    double spare = 0.0;
    if (work.pairs.size() == 1) hits = paths.find_hits(0, spare);
  }

  const dynamics::WorkPair& pair() const { return work.pairs.front(); }
  const dynamics::WorkBody& upper() const { return work.bodies[0]; }
  const dynamics::WorkBody& lower() const { return work.bodies[1]; }
};

Vec3 carried(const dynamics::WorkBody& body, const Vec3& point, const Pose& to) {
  return to.apply(body.start.apply_inverse(point));
}

}  // namespace

TEST_CASE("a body that goes straight on is, at a knot of the other, where its vertices are on their way") {
  const Meeting m;
  REQUIRE(m.upper().straight_parts == 1);
  REQUIRE(m.lower().straight_parts == 2);
  int before_the_end = 0;
  for (const dynamics::PathHit& hit : m.hits) {
    const auto& c = hit.contact;
    const Vec3 end = carried(m.upper(), c.on_a, m.upper().end);
    const Vec3 upper = (1.0 - hit.knot) * c.on_a + hit.knot * end;
    const Vec3 lower = carried(m.lower(), c.on_b, dynamics::pose_on_way(m.lower(), hit.knot));
    const dynamics::Opening opening = dynamics::make_opening(m.pair(), m.work, c, hit.knot, 0.0);
    CHECK(opening.gap == Approx(c.normal.dot(upper - lower)).margin(1e-15));
    CHECK(dynamics::gap_on_way(m.pair(), m.work, c, hit.knot) == opening.gap);
    if (hit.knot == 1.0) continue;
    ++before_the_end;
    // Turned half as far it would be elsewhere, by much more than the gap that is kept.
    const Vec3 turned = carried(m.upper(), c.on_a, dynamics::pose_on_way(m.upper(), hit.knot));
    CHECK(std::abs(c.normal.dot(turned - upper)) > 5.0 * m.pair().kept_gap);
  }
  CHECK(before_the_end > 0);
}

TEST_CASE("a hit tells how far apart its features were at the start, whichever way its normal turned") {
  const Meeting m;
  REQUIRE(!m.hits.empty());
  bool has_turned = false;
  for (const dynamics::PathHit& hit : m.hits) {
    const auto features = collision::FeaturePair::of_key(hit.contact.key);
    const auto points = collision::gather(features, *m.upper().collider, m.upper().start, *m.lower().collider,
                                          m.lower().start);
    CHECK(hit.start_gap == Approx(collision::measure(points, Vec3::UnitY()).gap));
    has_turned = has_turned || std::abs(hit.contact.gap - hit.start_gap) > 0.01 * hit.start_gap;
  }
  CHECK(has_turned);
}

TEST_CASE("features that pass each other by are not held where their surfaces would meet if they went on") {
  test::Scene scene;
  scene.settings.time_step = 1.0 / 240.0;
  scene.settings.gravity.setZero();
  body::Body plate = test::make_shell(test::square_mesh(0.05, 1)),
             chip = test::make_shell(test::square_mesh(0.004, 1));
  chip.pose = {Quat(core::sqrt(0.75), 0, 0, 0.5), Vec3(0.0495, 4.2e-3, 0.0)};
  scene.add(plate);
  for (const double aside : {12.0, 0.0}) {  // m/s: past the edge of the plate, or down on it
    chip.velocity = Vec3(aside, -1.5, 0.0);
    test::Scene both = scene;
    both.add(chip);
    dynamics::MotionWork work;
    both.fly(work);
    REQUIRE(work.pairs.size() == 1);
    const dynamics::WorkPair& pair = work.pairs.front();
    const auto &a = work.bodies[0], &b = work.bodies[1];
    collision::FeatureList features;
    collision::list_near_features(collision::place_collider(*a.collider, a.start),
                                  collision::place_collider(*b.collider, b.start), 1e-3, features);
    int close = 0;
    for (const collision::FeaturePair& f : features) {
      const auto here = collision::gather(f, *a.collider, a.start, *b.collider, b.start);
      const auto contact = collision::contact_here(f, here, collision::measure(here, Vec3::UnitY()));
      const double as_planes = dynamics::gap_on_way(pair, work, contact, 1.0);
      if (as_planes > 0.0) continue;
      ++close;
      const dynamics::Opening opening = dynamics::make_opening(pair, work, contact, 1.0, 1e-5);
      if (aside == 0.0) {
        CHECK(opening.gap == as_planes);
        continue;
      }
      const auto there = collision::gather(f, *a.collider, a.end, *b.collider, b.end);
      CHECK(opening.gap == collision::measure(there, Vec3::UnitY()).gap);
      CHECK(opening.gap > 1e-3);
    }
    CHECK(close > 0);
  }
}
