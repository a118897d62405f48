#include "engine/collision/broad_phase.h"

#include <algorithm>
#include <numeric>

#include "engine/core/index.h"
#include "engine/core/parallel.h"

namespace shatterbox::collision {
namespace {

using core::at;

constexpr std::size_t kChunk = 32;  // bodies that one thread looks about at once
constexpr std::size_t kFew = 24;    // that move: to sort all for them would take longer

// By a, then by b; both are below `count`.
std::vector<IndexPair> sorted(const std::vector<std::vector<IndexPair>>& lists, std::size_t count) {
  std::vector<std::size_t> begin(count + 1, 0);
  for (const auto& list : lists)
    for (const IndexPair& pair : list) ++begin[at(pair.a) + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<IndexPair> pairs(begin.back());
  std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
  for (const auto& list : lists)
    for (const IndexPair& pair : list) pairs[next[at(pair.a)]++] = pair;
  core::parallel_for(count, kChunk, [&](std::size_t a) {
    const auto first = pairs.begin();
    std::sort(first + static_cast<std::ptrdiff_t>(begin[a]),
              first + static_cast<std::ptrdiff_t>(begin[a + 1]),
              [](const IndexPair& x, const IndexPair& y) { return x.b < y.b; });
  });
  return pairs;
}

// Few that move, each against all.
std::vector<IndexPair> find_pairs_of(const std::vector<int>& moving, const std::vector<SweptBound>& bounds) {
  std::vector<std::vector<IndexPair>> lists(moving.size());
  core::parallel_for(moving.size(), 1, [&](std::size_t k) {
    const int mover = moving[k];
    for (int i = 0; i < static_cast<int>(bounds.size()); ++i) {
      const bool is_twice = bounds[at(i)].is_moving && i <= mover;  // of two that move, the first looks
      if (!is_twice && geometry::overlaps(bounds[at(mover)].box, bounds[at(i)].box))
        lists[k].push_back({std::min(mover, i), std::max(mover, i)});
    }
  });
  return sorted(lists, bounds.size());
}

}  // namespace

std::vector<IndexPair> find_overlapping_pairs(const std::vector<SweptBound>& bounds) {
  std::vector<int> moving;
  for (std::size_t i = 0; i < bounds.size() && moving.size() <= kFew; ++i)
    if (bounds[i].is_moving) moving.push_back(static_cast<int>(i));
  if (moving.size() <= kFew) return find_pairs_of(moving, bounds);
  std::vector<int> order(bounds.size());
  std::iota(order.begin(), order.end(), 0);
  const auto low = [&](int i) { return bounds[at(i)].box.low; };
  // The axis along which the bodies spread most leaves the fewest neighbours.
  geometry::Box spread;
  for (const auto& bound : bounds) {
    if (bound.box.low.x() <= bound.box.high.x()) spread.include(bound.box.low);
  }
  int axis = 0;
  if (spread.low.x() <= spread.high.x()) (spread.high - spread.low).maxCoeff(&axis);
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    return low(a)[axis] < low(b)[axis] || (low(a)[axis] == low(b)[axis] && a < b);
  });
  std::vector<SweptBound> in_order;
  in_order.reserve(order.size());
  for (const int i : order) in_order.push_back(bounds[at(i)]);
  std::vector<std::vector<IndexPair>> lists((order.size() + kChunk - 1) / kChunk);
  core::parallel_for(order.size(), kChunk, [&](std::size_t i) {
    const SweptBound& first = in_order[i];
    for (std::size_t j = i + 1; j < order.size(); ++j) {
      const SweptBound& second = in_order[j];
      if (second.box.low[axis] > first.box.high[axis]) break;
      if (!(first.is_moving || second.is_moving) || !geometry::overlaps(first.box, second.box)) continue;
      lists[i / kChunk].push_back({std::min(order[i], order[j]), std::max(order[i], order[j])});
    }
  });
  return sorted(lists, bounds.size());
}

}  // namespace shatterbox::collision
