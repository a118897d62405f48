// Disjoint sets (union and find) whose representative is the smallest member, so that the order of unions
// does not matter to the answer.
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace shatterbox::core {

class DisjointSets {
 public:
  /// `count` sets of one member each, 0 to count - 1.
  explicit DisjointSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }

  /// The smallest member of the set that i is in.
  int find(int i) {
    while (parent(i) != i) i = parent(i) = parent(parent(i));
    return i;
  }

  /// Makes the sets of i and j one.
  void unite(int i, int j) {
    i = find(i);
    j = find(j);
    if (i != j) parent(std::max(i, j)) = std::min(i, j);
  }

 private:
  int& parent(int i) { return parent_[static_cast<std::size_t>(i)]; }

  std::vector<int> parent_;
};

}  // namespace shatterbox::core
