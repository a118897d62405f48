// Features on straight paths: against sampled ways, and with what is remembered against what is found anew.
#include "engine/dynamics/feature_paths.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <memory>
#include <set>
#include <vector>

#include "engine/collision/feature_gap.h"
#include "engine/dynamics/motion_work.h"
#include "tests/engine/draw.h"
#include "tests/engine/dynamics/facing_sheets.h"

namespace shatterbox::dynamics {
namespace {

using test::FacingSheets;
using test::kGap;

std::set<std::uint64_t> keys_of(const std::vector<PathHit>& hits) {
  std::set<std::uint64_t> keys;
  for (const PathHit& hit : hits) keys.insert(hit.contact.key);
  return keys;
}

void move_end(core::Random& random, double by, WorkBody& w) {
  w.end.translation += by * test::draw_vector(random);
  w.end.rotation = (test::draw_turn(random, 0.1 * by) * w.end.rotation).normalized();
}

}  // namespace

TEST_CASE("features that are said to keep apart do so all the way") {
  core::Random random(5);
  int free_pairs = 0, hit_pairs = 0;
  for (int n = 0; n < 40; ++n) {
    FacingSheets sheets(random, 4);
    sheets.a.end.translation = 4.0 * kGap * (test::draw_vector(random) + Vec3(0, 0.5, 0));
    move_end(random, kGap, sheets.b);
    sheets.search(20.0 * kGap);
    double spare = 0.0;
    const auto hits = keys_of(sheets.follow(spare));
    (hits.empty() ? free_pairs : hit_pairs) += 1;
    double least = 1e300, least_at_end = 1e300;
    for (const auto& f : sheets.pair.search->features) {
      if (hits.count(f.key()) != 0) continue;
      const auto from = collision::gather(f, *sheets.a.collider, sheets.a.placed.start, *sheets.b.collider,
                                          sheets.b.placed.start);
      const auto to =
          collision::gather(f, *sheets.a.collider, sheets.ends_a, *sheets.b.collider, sheets.ends_b);
      for (int k = 0; k <= 20; ++k) {
        auto now = from;
        for (std::size_t i = 0; i < 4; ++i) now.points[i] += 0.05 * k * (to.points[i] - from.points[i]);
        const double here = collision::measure(now, Vec3::UnitY()).gap;
        least = std::min(least, here);
        if (k == 20) least_at_end = std::min(least_at_end, here);
      }
    }
    CHECK(least >= kSafe * kGap - 1e-15);
    // Only the ends are moved from one test to the next.
    if (hits.empty()) CHECK(least_at_end >= kSafe * kGap + spare - 1e-15);
  }
  CHECK(free_pairs > 3);
  CHECK(hit_pairs > 3);
}

// Features that are known to be free where the ends are.
int count_known(const WorkPair& pair) {
  int count = 0;
  for (std::size_t number = 0; number < pair.known.blocks.size(); ++number) {
    const auto [begin, end] = pair.search->features_of(number);
    for (std::size_t i = begin; pair.known.blocks[number].is_begun && i < end; ++i)
      count += pair.known.features[i].free_until > pair.known.moved ? 1 : 0;
  }
  return count;
}

TEST_CASE("what is remembered of features finds the hits that a test without memory finds") {
  core::Random random(7);
  int hits_found = 0, skipped = 0;
  for (int n = 0; n < 20; ++n) {
    FacingSheets sheets(random, 5);
    sheets.a.end.translation = 3.0 * kGap * (test::draw_vector(random) + Vec3(0, 1, 0));
    sheets.search(40.0 * kGap);
    for (int k = 0; k < 8; ++k) {
      double spare = 0.0, spare_anew = 0.0;
      const auto hits = keys_of(sheets.follow(spare));
      PathMemory kept = std::move(sheets.pair.known);
      sheets.pair.known = PathMemory();
      CHECK(keys_of(sheets.follow(spare_anew)) == hits);
      hits_found += static_cast<int>(hits.size());
      sheets.pair.known = std::move(kept);
      skipped += count_known(sheets.pair);
      // The ends move a little, or anywhere.
      const Pose before = sheets.a.end;
      move_end(random, k % 3 == 2 ? 3.0 * kGap : 0.3 * kGap, sheets.a);
      if (k % 3 == 2)
        sheets.pair.known.forget_ends(sheets.pair.search.get());
      else
        sheets.pair.known.moved += (sheets.a.end.translation - before.translation).norm() +
                                   turn_bound(before.rotation, sheets.a.end.rotation, sheets.a.reach);
    }
  }
  CHECK(hits_found > 100);
  CHECK(skipped > 1000);
}

TEST_CASE("gaps that were measured before the first test are known to it") {
  core::Random random(9);
  FacingSheets sheets(random, 3);
  sheets.a.end.translation = Vec3(0, -2e-3, 0);
  sheets.search(0.02);
  // They say that nothing can be reached.
  auto gaps = std::make_shared<StartGaps>();
  gaps->search = sheets.pair.search;
  gaps->gaps.assign(sheets.pair.search->features.size(), 1.0F);
  sheets.pair.known.start_gaps = gaps;
  double spare = 0.0;
  CHECK(sheets.follow(spare).empty());
  sheets.pair.known = PathMemory();
  CHECK(!sheets.follow(spare).empty());
}

}  // namespace shatterbox::dynamics
