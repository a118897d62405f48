// Whether bodies may take the ways to their end poses: no path of a vertex or an edge may come closer to
// another surface than the least separation. No false negatives: by separating directions. [BFA02], [BHTF07]
// sec. III.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "engine/dynamics/contact_settings.h"
#include "engine/dynamics/feature_paths.h"
#include "engine/dynamics/motion_work.h"
#include "engine/dynamics/turned_box.h"
#include "engine/dynamics/turning_paths.h"

namespace shatterbox::dynamics {

class PathTest {
 public:
  PathTest(const ContactSettings& settings, MotionWork& work)
      : settings_(settings), work_(work), turning_(settings, work) {}

  /// Places the bodies of the pairs that are due at their ends, and looks for features that may meet.
  void prepare(const std::vector<std::size_t>& due);

  /// Where the pair meets, earliest first; empty if its way is free. Then ways that stay within `spare` (m)
  /// of it are free too. Different pairs may be tested at once.
  std::vector<PathHit> find_hits(std::size_t pair_number, double& spare);

 private:
  // What is to be done for a pair.
  enum class Look : char {
    apart,     // nothing: boxes tell that its bodies do not meet
    listed,    // go through the features that were listed
    searched,  // list them first
    turning    // one of the two turns far: by straight parts
  };
  Look look_at(std::size_t pair_number);
  void box_ways(const std::vector<std::size_t>& due);
  std::vector<PathHit> test_plane(const WorkPair& pair, double& spare) const;
  std::vector<PathHit> test_solids(const WorkPair& pair) const;
  std::vector<PathHit> test_straight(WorkPair& pair, double strays, double& spare) const;

  const ContactSettings& settings_;
  MotionWork& work_;
  TurningPaths turning_;
  std::vector<TurnedBox> boxes_;    // per body, about the whole way, if that is straight
  std::vector<Look> looks_;         // per pair
  std::vector<double> clearances_;  // per pair, m: how far its bodies surely stay apart
  std::vector<double> strays_;      // per pair, m: how far its ways lead from what was searched, if looked at
};

}  // namespace shatterbox::dynamics
