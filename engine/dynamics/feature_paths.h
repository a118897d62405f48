// Whether the features of one pair of bodies keep apart on straight paths, and what is known of them from one
// test to the next while the starts stay: only ends are moved between the tests of a step.
#pragma once

#include <cstddef>
#include <vector>

#include "engine/collision/contact.h"
#include "engine/core/vec.h"
#include "engine/dynamics/feature_search.h"

namespace shatterbox::dynamics {

struct WorkBody;
struct WorkPair;

/// Least separation after the continuous pass, share of the kept gap.
inline constexpr double kSafe = 1e-3;

struct PathHit {
  double time = 1.0;           // share of the step that is certainly free
  double knot = 1.0;           // share of the step at the end of the straight part in which they meet
  collision::Contact contact;  // seen from the start, along its normal at the hit
  double start_gap = 0.0;      // m, between the two at the start; of solids along that normal
};

/// What a pair may come to within a step, m, that begins at `gap`: opening motion is always free, and what is
/// closer than a direction can be told must not come closer at all; where the gap has a sign, but for
/// rounding.
double least_separation(double gap, const WorkPair& pair);

/// Where the bodies of a pair go, and how far that was looked at.
struct PairPaths {
  const std::vector<Vec3>&ends_a, &ends_b;  // |V| x 3, world, m
  double reach = 0.0;                       // m: gaps at the start that are greater stay free
  double spare = 0.0;                       // m: what the search leaves, at most the kept gap
  double listed = 0.0;  // m: features of a swept list with a greater bound stay free, by `spare` and more
  double ample = 0.0;   // m: `reach` and `listed` speak for so much room and no more
};

/// Tests the features of `pair.search` on these paths, which its memory is of. Returns the hits, in any order
/// that is always the same; lowers `spare` (m): ways that stay within it of these are free too.
std::vector<PathHit> follow_features(const WorkBody& a, const WorkBody& b, const PairPaths& paths,
                                     WorkPair& pair, double& spare);

}  // namespace shatterbox::dynamics
