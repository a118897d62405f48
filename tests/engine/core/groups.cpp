#include "engine/core/groups.h"

#include <algorithm>
#include <catch2/catch.hpp>

#include "engine/core/random.h"

namespace shatterbox::core {
namespace {

std::vector<std::size_t> list(std::span<const std::size_t> things) {
  return {things.begin(), things.end()};
}

}  // namespace

TEST_CASE("groups hold what belongs to them, ascending") {
  const std::vector<std::size_t> group_of{2, 0, 2, 3, 0};
  const Groups groups(5, group_of.size(), [&](std::size_t i) { return group_of[i]; });
  CHECK(groups.count_things() == 5);
  CHECK(list(groups.of(0)) == std::vector<std::size_t>{1, 4});
  CHECK(list(groups.of(1)).empty());
  CHECK(list(groups.of(2)) == std::vector<std::size_t>{0, 2});
  CHECK(list(groups.of(3)) == std::vector<std::size_t>{3});
  CHECK(list(groups.of(4)).empty());
  CHECK(Groups().count_things() == 0);
}

TEST_CASE("every thing is in one group") {
  Random random(5);
  std::vector<std::size_t> group_of(1000);
  for (std::size_t& group : group_of) group = static_cast<std::size_t>(random.uniform(0.0, 40.0));
  const Groups groups(40, group_of.size(), [&](std::size_t i) { return group_of[i]; });
  std::size_t seen = 0;
  for (std::size_t group = 0; group < 40; ++group) {
    const auto things = groups.of(group);
    CHECK(std::is_sorted(things.begin(), things.end()));
    for (const std::size_t i : things) CHECK(group_of[i] == group);
    seen += things.size();
  }
  CHECK(seen == group_of.size());
}

}  // namespace shatterbox::core
