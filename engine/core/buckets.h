// Things sorted by key, by counting.
#pragma once

#include <cstddef>
#include <numeric>
#include <span>
#include <vector>

namespace shatterbox::core {

/// Groups `count` items by key in [0, keys): items of key k are [first[k], first[k + 1]) of `items`,
/// ascending. What has a negative key is in none.
struct Buckets {
  std::vector<int> first, items;

  Buckets() = default;

  template <class Key>
  Buckets(std::size_t keys, std::size_t count, const Key& key) : first(keys + 1, 0) {
    for (std::size_t i = 0; i < count; ++i)
      if (const int k = key(i); k >= 0) ++first[static_cast<std::size_t>(k) + 1];
    std::partial_sum(first.begin(), first.end(), first.begin());
    items.resize(static_cast<std::size_t>(first.back()));
    std::vector<int> fill(first.begin(), first.end() - 1);
    for (std::size_t i = 0; i < count; ++i)
      if (const int k = key(i); k >= 0)
        items[static_cast<std::size_t>(fill[static_cast<std::size_t>(k)]++)] = static_cast<int>(i);
  }

  std::span<const int> of(std::size_t key) const {
    return {items.begin() + first[key], items.begin() + first[key + 1]};
  }
};

}  // namespace shatterbox::core
