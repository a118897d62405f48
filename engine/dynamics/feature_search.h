// A list of feature pairs together with the motions for which it is known to hold all that can touch. Made
// once, never changed, shared between steps and passes: a cache that changes no result.
#pragma once

#include "engine/collision/feature_list.h"
#include "engine/core/vec.h"

namespace shatterbox::dynamics {

struct WorkBody;

struct FeatureSearch {
  collision::FeatureList features;  // ascending by `bound` unless swept
  double margin = 0.0;              // m: all that come this close are in it
  bool is_swept = false;            // looked along straight paths, not only at the starts
  Pose start_a, start_b;            // where the bodies were
  Pose end_a, end_b;                // swept: where they were thought to go
};

/// No point within `reach` of the origin moves further than this by the turn from one rotation to the other,
/// m.
double turn_bound(const Quat& from, const Quat& to, double reach);

/// How much closer features may be at these poses than where the search began, m, of those that are within
/// `near` (m) of each other now.
double moved_since(const FeatureSearch& search, const WorkBody& a, const Pose& pose_a, const WorkBody& b,
                   const Pose& pose_b, double near);

/// Paths from the bodies' starts to these ends stay within this of what was looked at, m, where they come
/// within `near` (m): with a margin so much above that, the search holds all that they can touch.
double strays_from(const FeatureSearch& search, const WorkBody& a, const Pose& end_a, const WorkBody& b,
                   const Pose& end_b, double near);

}  // namespace shatterbox::dynamics
