// Do two features meet while their vertices move along straight lines? Point against triangle and edge
// against edge, on plain arrays, with a least separation. No false negatives: "free" is proven, rounding
// included; a path that only comes very near may be called a hit. By separating directions, not by roots of a
// cubic [BFA02].
#pragma once

#include <array>

namespace shatterbox::geometry {

/// What is known of a pair of features whose vertices move along straight lines during the times [0, 1].
struct ContinuousResult {
  bool hit = false;             // false: their distance surely stays above the least separation at all times
  double time_of_impact = 1.0;  // until then (exclusive) the distance surely stays above: never late
  double distance = 0.0;        // m, at that time, with rounding errors
  std::array<double, 3>
      normal{};        // unit, from the second feature to the first at that time; 0 if they coincide
  int iterations = 0;  // separating directions that were tried
};

/// A point and a triangle. `point_*`: x, y, z; `triangle_*`: x, y, z of the three corners (9 numbers), m, at
/// the times 0 and 1. `least_separation` >= 0 (m): distances up to it are hits; 0 asks whether they touch. A
/// hit may also be told where the distance falls below `least_separation + slack`: a slack saves iterations.
/// Everything may be degenerate; coordinates must be finite and of sizes from 1e-70 to 1e70 (smaller ones may
/// give needless hits).
ContinuousResult test_point_triangle(const double* point_start, const double* triangle_start,
                                     const double* point_end, const double* triangle_end,
                                     double least_separation, double slack = 0.0);

/// Two edges, each given by x, y, z of its two ends (6 numbers), m, at the times 0 and 1. Otherwise as above.
ContinuousResult test_edge_edge(const double* edge_a_start, const double* edge_b_start,
                                const double* edge_a_end, const double* edge_b_end, double least_separation,
                                double slack = 0.0);

}  // namespace shatterbox::geometry
