#include "engine/collision/broad_phase.h"

#include <algorithm>
#include <numeric>

namespace shatterbox::collision {

std::vector<IndexPair> find_overlapping_pairs(const std::vector<SweptBound>& bounds) {
  std::vector<int> order(bounds.size());
  std::iota(order.begin(), order.end(), 0);
  const auto low = [&](int i) { return bounds[static_cast<std::size_t>(i)].box.low; };
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
  std::vector<IndexPair> pairs;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const SweptBound& first = bounds[static_cast<std::size_t>(order[i])];
    for (std::size_t j = i + 1; j < order.size(); ++j) {
      const SweptBound& second = bounds[static_cast<std::size_t>(order[j])];
      if (second.box.low[axis] > first.box.high[axis]) break;
      if (!(first.is_moving || second.is_moving) || !geometry::overlaps(first.box, second.box)) continue;
      pairs.push_back({std::min(order[i], order[j]), std::max(order[i], order[j])});
    }
  }
  std::sort(pairs.begin(), pairs.end(),
            [](const IndexPair& x, const IndexPair& y) { return x.a < y.a || (x.a == y.a && x.b < y.b); });
  return pairs;
}

}  // namespace shatterbox::collision
