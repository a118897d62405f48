// A list of feature pairs together with the motions for which it is known to hold all that can touch. Made
// once, never changed, shared between steps and passes: a cache that changes no result.
#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "engine/collision/feature_list.h"
#include "engine/core/vec.h"

namespace shatterbox::dynamics {

struct WorkBody;

struct FeatureSearch {
  collision::FeatureList features;              // in any order that is always the same
  double margin = 0.0;                          // m: all that come this close are in it
  bool is_swept = false;                        // looked along straight paths, not only at the starts
  Pose start_a, start_b;                        // where the bodies were
  Pose end_a, end_b;                            // swept: where they were thought to go
  std::vector<collision::FeatureBlock> blocks;  // swept: of the features, in their order

  /// A swept list has blocks; of others fixed numbers of features are one.
  std::size_t block_count() const;
  /// The first feature of a block, and the one behind its last.
  std::pair<std::size_t, std::size_t> features_of(std::size_t block) const;
};

/// How near the features of a search may be where the bodies are: what has moved by little need not be
/// measured again. Shared as the search is; who alone holds it may go on with it.
struct StartGaps {
  std::shared_ptr<const FeatureSearch> search;
  Pose start_a, start_b;
  std::vector<float> gaps;  // m: none is less, in the order of the features
  double least = -1e300;    // m, of them, once they were measured
};

/// What is known of the features of a search, for the starts where they are.
struct PathMemory {
  static constexpr double kUnknown = -1e300;
  struct Block {
    double free_until = -1.0;     // m, of all of it
    Vec3 parting = Vec3::Zero();  // at the start its leaves are apart along this; zero: unknown
    bool is_begun = false;        // its features are set
  };
  struct Feature {
    double start_gap;   // m: at least that
    double free_until;  // m: until the ends have moved so far in all, counted in `moved`, it is free
    Vec3 parting;       // as of a block
  };
  std::shared_ptr<const StartGaps> start_gaps;  // known before any test, or none
  // One of the straight parts of ways on which a body turns far.
  struct Part {
    std::size_t number = 0;
    collision::FeatureList features;  // all that came within `searched` on it
    std::vector<double> free_until;   // m, per feature, as above
  };
  std::unique_ptr<Feature[]> features;  // of the search, once it was tested
  std::vector<Block> blocks;            // the same
  std::vector<Part> parts;              // those with features, ascending
  std::size_t part_count = 0;           // of how many; 0: nothing is known
  double moved = 0.0;
  double listed_at = 0.0;  // m: `moved` when the parts' features were listed
  double searched = 0.0;   // m: margin of what was searched for the tests of this step

  /// The ends are elsewhere, in tests of `search`, if any.
  void forget_ends(const FeatureSearch* search);
};

/// To the bit.
bool is_same_pose(const Pose& x, const Pose& y);

/// No point within `reach` of the origin moves further than this by the turn from one rotation to the other,
/// m.
double turn_bound(const Quat& from, const Quat& to, double reach);

/// How much closer features may be at the starts than where the search began, m, of those that are within
/// `near` (m) of each other now.
double moved_since(const FeatureSearch& search, const WorkBody& a, const WorkBody& b, double near);

/// What a search that was just made knows by its own bounds.
StartGaps gaps_of(std::shared_ptr<const FeatureSearch> search);

/// Makes of what is known of gaps where the bodies were what is known where they are now.
void carry_gaps(StartGaps& gaps, const WorkBody& a, const WorkBody& b);

/// Straight paths from the bodies' starts to these ends bring features that are within `near` (m) of each
/// other closer by no more than this, m.
double approach_bound(const WorkBody& a, const Pose& end_a, const WorkBody& b, const Pose& end_b,
                      double near);

/// Paths from the bodies' starts to these ends stay within this of what was looked at, m, where they come
/// within `near` (m): with a margin so much above that, the search holds all that they can touch.
double strays_from(const FeatureSearch& search, const WorkBody& a, const Pose& end_a, const WorkBody& b,
                   const Pose& end_b, double near);

}  // namespace shatterbox::dynamics
