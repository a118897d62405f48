// No false negatives, and no late times, against an oracle that rounds nothing.
#include "engine/geometry/continuous_tests.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>

#include "tests/engine/geometry/continuous_queries.h"
#include "tests/support/exact_contact.h"
#include "tests/support/sanitized.h"

using shatterbox::geometry::ContinuousResult;
using shatterbox::geometry::test_edge_edge;
using shatterbox::geometry::test_point_triangle;
using namespace shatterbox::test;

namespace {

ContinuousResult ask(const Motion& m, double least, double slack = 0.0) {
  const double *start = m.start[0].data(), *end = m.end[0].data();
  return m.is_edge_edge ? test_edge_edge(start, start + 6, end, end + 6, least, slack)
                        : test_point_triangle(start, start + 3, end, end + 3, least, slack);
}

/// A time at which the features are close, by sampling.
double find_near_time(const Motion& m) {
  double low = 0.0, high = 1.0, best = 1e300, best_time = 0.0;
  for (int level = 0; level < 12; ++level) {
    for (int i = 0; i <= 16; ++i) {
      const double t = low + (high - low) * i / 16.0;
      Motion still = m;
      for (std::size_t k = 0; k < 4; ++k)
        for (std::size_t a = 0; a < 3; ++a)
          still.start[k][a] = still.end[k][a] = m.start[k][a] + t * (m.end[k][a] - m.start[k][a]);
      const double d = ask(still, 0.0).distance;
      if (d < best) {
        best = d;
        best_time = t;
      }
    }
    const double width = (high - low) / 8.0;
    low = std::max(0.0, best_time - width);
    high = std::min(1.0, best_time + width);
  }
  return best_time;
}

/// Greatest coordinate of a difference of vertices, at both ends.
double size_of(const Motion& m) {
  double size = 0.0;
  for (const auto* x : {&m.start, &m.end})
    for (const auto& point : *x)
      for (std::size_t k = 0; k < 3; ++k) size = std::max(size, std::abs(point[k] - (*x)[3][k]));
  return size;
}

struct Tally {
  long queries = 0, contacts = 0, missed = 0, late = 0;
  long rounding = 0, needless = 0;  // hits without contact: nearer than 1e-13 of the size, and others
  long iterations = 0, most_iterations = 0;
};

void add_to(Tally& tally, const Motion& motion) {
  const ContinuousResult result = ask(motion, 0.0);
  const std::vector<Root> times = contact_times(motion);
  ++tally.queries;
  tally.contacts += times.empty() ? 0 : 1;
  tally.missed += !times.empty() && !result.hit ? 1 : 0;
  if (times.empty() && result.hit) {
    const bool is_rounding = is_within(motion, result.time_of_impact, 1e-13 * size_of(motion));
    ++(is_rounding ? tally.rounding : tally.needless);
  }
  const Dyadic time = dyadic_of(result.time_of_impact);
  tally.late += std::any_of(times.begin(), times.end(), [&](const Root& r) { return is_before(r, time); });
  tally.iterations += result.iterations;
  tally.most_iterations = std::max<long>(tally.most_iterations, result.iterations);
}

void ask_many(std::uint64_t seed, std::uint64_t count) {
  std::array<Tally, kQueryKinds.size()> tallies;
  for (std::uint64_t i = 0; i < count; ++i) add_to(tallies[i % tallies.size()], make_query(seed, i));
  long needless = 0, rounding = 0, missed = 0, late = 0;
  std::printf("%-22s %8s %8s %6s %4s %12s %8s %6s\n", "", "queries", "contacts", "missed", "late",
              "at rounding", "needless", "tries");
  for (std::size_t k = 0; k < tallies.size(); ++k) {
    const Tally& t = tallies[k];
    std::printf("%-22s %8ld %8ld %6ld %4ld %12ld %8ld %6.2f, at most %ld\n", kQueryKinds[k], t.queries,
                t.contacts, t.missed, t.late, t.rounding, t.needless,
                double(t.iterations) / double(t.queries), t.most_iterations);
    needless += t.needless;
    rounding += t.rounding;
    missed += t.missed;
    late += t.late;
    CHECK(t.contacts > t.queries / 50);  // the queries are worth asking
    CHECK(t.contacts < t.queries);
  }
  std::printf(
      "false negatives %ld, late times %ld, false positives %ld (and %ld at the level of rounding) of %llu\n",
      missed, late, needless, rounding, static_cast<unsigned long long>(count));
  CHECK(missed == 0);
  CHECK(late == 0);
  CHECK(needless < static_cast<long>(count / 200));
}

}  // namespace

TEST_CASE("continuous tests: random and adversarial queries, no false negative, never late") {
  // 5000 are some hundreds of each kind; the rare ones are the other builds' and the long test's to find.
  ask_many(1, static_cast<std::uint64_t>(how_many(100000, 5000)));
}

TEST_CASE("continuous tests: 1e7 queries", "[.][long]") {
  ask_many(2, 10000000);
}

TEST_CASE("continuous tests: no false negative with a least separation") {
  long within = 0, free = 0;
  const long count = how_many(4000, 800);
  for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(count); ++i) {
    const Motion motion = make_query(3, i);
    const double time = find_near_time(motion);
    for (const double share : {1e-9, 1e-4, 0.1}) {
      const double least = share * size_of(motion);
      const ContinuousResult result = ask(motion, least);
      const bool is_near = is_within(motion, time, least);  // exactly
      within += is_near ? 1 : 0;
      free += result.hit ? 0 : 1;
      INFO("query " << i << ", least separation " << least);
      REQUIRE((result.hit || !is_near));
      REQUIRE((!is_near || result.time_of_impact <= time));
      // The time itself is free: the distance there is not below the least separation but by rounding.
      if (result.time_of_impact > 0.0)
        REQUIRE_FALSE(is_within(motion, result.time_of_impact * (1 - 1e-9), least * (1 - 1e-9)));
    }
  }
  CHECK(within > count * 3 / 4);
  CHECK(free > count * 3 / 4);
}

TEST_CASE("continuous tests: a point falls through a triangle, at the time that is known") {
  const double triangle[9] = {0, 0, 0, 1, 0, 0, 0, 0, 1};
  const double start[3] = {0.25, 3.0, 0.25}, end[3] = {0.25, -1.0, 0.25};
  const auto touch = test_point_triangle(start, triangle, end, triangle, 0.0);
  CHECK(touch.hit);
  CHECK(touch.time_of_impact <= 0.75);
  CHECK(touch.time_of_impact == Approx(0.75).epsilon(1e-12));
  const auto near = test_point_triangle(start, triangle, end, triangle, 0.01);
  CHECK(near.hit);
  CHECK(near.time_of_impact == Approx(0.7475).epsilon(1e-9));
  CHECK(near.normal[1] == Approx(1.0));
  CHECK(near.distance == Approx(0.01).epsilon(1e-9));
  const double above[3] = {0.25, 0.011, 0.25};
  CHECK_FALSE(test_point_triangle(start, triangle, above, triangle, 0.01).hit);
  CHECK(test_point_triangle(start, triangle, above, triangle, 0.01, 0.01).time_of_impact == 1.0);
}

TEST_CASE("continuous tests: crossed edges pass at a known time, one beside the other does not") {
  const double low[6] = {-1, 0, 0, 1, 0, 0};
  const double start[6] = {0, 1, -1, 0, 1, 1}, end[6] = {0, -1, -1, 0, -1, 1};
  const auto pass = test_edge_edge(low, start, low, end, 0.0);
  CHECK(pass.hit);
  CHECK(pass.time_of_impact == Approx(0.5).epsilon(1e-12));
  CHECK(pass.normal[1] < 0.5);  // from the second to the first: down, or nothing where they coincide
  const double beside_start[6] = {0, 1, 1e-6, 0, 1, 1}, beside_end[6] = {0, -1, 1e-6, 0, -1, 1};
  CHECK_FALSE(test_edge_edge(low, beside_start, low, beside_end, 0.0).hit);
  CHECK(test_edge_edge(low, beside_start, low, beside_end, 1e-5).hit);
}

TEST_CASE("continuous tests: the oracle itself, on motions with known contacts") {
  Motion m;
  m.start = {{{0.25, 3, 0.25}, {0, 0, 0}, {1, 0, 0}, {0, 0, 1}}};
  m.end = m.start;
  m.end[0][1] = -1.0;
  auto times = contact_times(m);
  REQUIRE(times.size() == 1);
  CHECK_FALSE(is_before(times[0], dyadic_of(0.75)));
  CHECK(is_before(times[0], dyadic_of(0.75 * (1 + 1e-15))));
  m.end[0][1] = 0x1p-60;
  CHECK(contact_times(m).empty());
  m.end[0][1] = 0.0;  // arrives at the end
  CHECK(contact_times(m).size() == 1);
  m.start[0] = {2, 0, 0.25};  // in the plane of the triangle, towards its long edge, which it meets half-way
  m.end[0] = {-0.5, 0, 0.25};
  times = contact_times(m);
  REQUIRE_FALSE(times.empty());
  CHECK(is_before(times[0], dyadic_of(0.5 + 1e-9)));
  CHECK_FALSE(is_before(times[0], dyadic_of(0.5)));
  m.end[0] = {1.0, 0, 0.25};
  CHECK(contact_times(m).empty());
  CHECK(is_within(m, 1.0, 0.18));  // 0.25 / sqrt 2
  CHECK_FALSE(is_within(m, 1.0, 0.17));
  // A corner that turns through a plane and back touches at a root of even order.
  Motion graze;
  graze.is_edge_edge = true;
  graze.start = {{{-1, 0, 0}, {1, 0, 0}, {0, 1, -1}, {0, -1, 1}}};
  graze.end = {{{-1, 0, 0}, {1, 0, 0}, {0, -1, -1}, {0, 1, 1}}};
  CHECK_FALSE(contact_times(graze).empty());
}
