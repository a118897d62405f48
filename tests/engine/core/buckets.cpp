#include "engine/core/buckets.h"

#include <algorithm>
#include <catch2/catch.hpp>

#include "engine/core/index.h"
#include "engine/core/random.h"

namespace shatterbox::core {
namespace {

std::vector<int> list(std::span<const int> items) {
  return {items.begin(), items.end()};
}

}  // namespace

TEST_CASE("buckets hold what has their key, ascending") {
  const std::vector<int> keys{2, 0, -1, 2, 3, 0};
  const Buckets buckets(5, keys.size(), [&](std::size_t i) { return keys[i]; });
  CHECK(buckets.items.size() == 5);
  CHECK(list(buckets.of(0)) == std::vector<int>{1, 5});
  CHECK(list(buckets.of(1)).empty());
  CHECK(list(buckets.of(2)) == std::vector<int>{0, 3});
  CHECK(list(buckets.of(3)) == std::vector<int>{4});
  CHECK(list(buckets.of(4)).empty());
  CHECK(Buckets().items.empty());
}

TEST_CASE("every item is in one bucket") {
  Random random(5);
  std::vector<int> keys(1000);
  for (int& key : keys) key = static_cast<int>(random.uniform(0.0, 40.0));
  const Buckets buckets(40, keys.size(), [&](std::size_t i) { return keys[i]; });
  std::size_t seen = 0;
  for (int key = 0; key < 40; ++key) {
    const auto items = buckets.of(at(key));
    CHECK(std::is_sorted(items.begin(), items.end()));
    for (const int i : items) CHECK(keys[at(i)] == key);
    seen += items.size();
  }
  CHECK(seen == keys.size());
}

}  // namespace shatterbox::core
