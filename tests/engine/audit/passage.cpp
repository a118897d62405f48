// Passages against the oracle of contacts that rounds nothing.
#include "engine/audit/passage.h"

#include <catch2/catch.hpp>
#include <cstdio>

#include "tests/engine/geometry/continuous_queries.h"
#include "tests/support/exact_contact.h"
#include "tests/support/sanitized.h"

using namespace shatterbox;
using namespace shatterbox::audit;
using test::Motion;

namespace {

Passage ask(const Motion& m) {
  FourPoints start, end;
  for (std::size_t i = 0; i < 4; ++i) {
    start[i] = Vec3(m.start[i][0], m.start[i][1], m.start[i][2]);
    end[i] = Vec3(m.end[i][0], m.end[i][1], m.end[i][2]);
  }
  return m.is_edge_edge ? edge_through_edge(start, end) : vertex_through_triangle(start, end);
}

}  // namespace

TEST_CASE("audit: what surely passed has touched, and what touches is never told to be clear") {
  std::array<long, 3> counts{};
  long random_contacts = 0, random_unsettled = 0;
  const long motions = test::how_many(30000, 3000);
  for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(motions); ++i) {
    const Motion motion = test::make_query(11, i);
    const Passage passage = ask(motion);
    const bool has_contact = !test::contact_times(motion).empty();
    ++counts[static_cast<std::size_t>(passage)];
    INFO("query " << i << " of kind " << test::kQueryKinds[i % test::kQueryKinds.size()]);
    REQUIRE_FALSE((passage == Passage::passed && !has_contact));
    REQUIRE_FALSE((passage == Passage::none && has_contact));
    if (i % test::kQueryKinds.size() != 0) continue;
    random_contacts += has_contact ? 1 : 0;
    random_unsettled += passage == Passage::unsettled ? 1 : 0;
  }
  std::printf("%ld motions: %ld clear, %ld passed, %ld touch or nearly touch\n", motions, counts[0],
              counts[1], counts[2]);
  CHECK(counts[1] > motions / 10);
  CHECK(random_contacts > motions / 150);
  CHECK(random_unsettled == 0);
}

TEST_CASE("audit: a corner that sweeps past a turning triangle has not passed through it") {
  // Linear interpolation of the distance to the plane would call this a passage: the triangle turns by half a
  // turn about its own long axis while the vertex goes by far from it.
  const FourPoints start{Vec3(0, 1, 0), Vec3(-5, 0, 1), Vec3(5, 0, 1), Vec3(0, 0, -1)};
  const FourPoints end{Vec3(0, 1, 0), Vec3(-5, 0, -1), Vec3(5, 0, -1), Vec3(0, 0, 1)};
  CHECK(vertex_through_triangle(start, end) == Passage::none);
  const FourPoints through{Vec3(0, -1, 0.1), Vec3(-5, 0, 1), Vec3(5, 0, 1), Vec3(0, 0, -1)};
  FourPoints still = through;
  still[0] = Vec3(0, 1, 0.1);
  CHECK(vertex_through_triangle(through, still) == Passage::passed);
  still[0] = Vec3(0, 0, 0.1);  // arrives: touches
  CHECK(vertex_through_triangle(through, still) == Passage::unsettled);
  still[0] = Vec3(0, -1e-12, 0.1);
  CHECK(vertex_through_triangle(through, still) == Passage::none);
}
