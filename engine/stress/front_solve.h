// Triangular solves with the factored fronts, for one or four right-hand sides at once. Lanes never mix, so a
// right-hand side gets the same bits whatever company it has; fronts that no load has reached are passed
// over, so a load on a small part, or one that is only carried forward, costs little.
#pragma once

#include <vector>

#include "engine/stress/front_factor.h"
#include "engine/stress/front_tree.h"

namespace shatterbox::stress {

/// Right-hand sides or solutions side by side: value l of unknown i (by place in the order of elimination) is
/// values[lanes i + l].
struct SolveLanes {
  static constexpr int kMost = 4;
  int lanes = kMost;  // 1 or kMost
  std::vector<double> values;

  SolveLanes(const FrontTree& tree, std::size_t count)
      : lanes(count == 1 ? 1 : kMost),
        values(static_cast<std::size_t>(lanes) * static_cast<std::size_t>(tree.unknowns), 0.0) {}
};

/// x <- L^-1 x
void solve_forward(const FrontTree& tree, const FrontFactor& factor, SolveLanes& x);
/// x <- L^-T x
void solve_backward(const FrontTree& tree, const FrontFactor& factor, SolveLanes& x);

}  // namespace shatterbox::stress
