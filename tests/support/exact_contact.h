// Oracle: when a point meets a triangle, or an edge an edge, whose vertices move along straight lines during
// [0, 1]. Exact by construction: whole numbers of any size, nothing is rounded. Degenerate features and
// motions in a plane or along a line are cases like any other.
#pragma once

#include <array>
#include <vector>

#include "tests/support/exact_polynomial.h"

namespace shatterbox::test {

/// Four vertices at the times 0 and 1, m: a point and the corners of a triangle, or the ends of two edges.
struct Motion {
  bool is_edge_edge = false;
  std::array<std::array<double, 3>, 4> start{}, end{};
};

/// Times in [0, 1] at which the closed features share a point. The first contact is among them; where they
/// stay together, later times may be missing.
std::vector<Root> contact_times(const Motion& motion);

/// True if the squared distance of the features at `time` is at most the square of `least`, exactly.
bool is_within(const Motion& motion, double time, double least);

}  // namespace shatterbox::test
