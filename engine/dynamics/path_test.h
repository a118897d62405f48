// Whether bodies may take the ways to their end poses: no path of a vertex or an edge may come closer to
// another surface than the least separation. No false negatives: by separating directions. [BFA02], [BHTF07]
// sec. III.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "engine/dynamics/contact_settings.h"
#include "engine/dynamics/feature_paths.h"
#include "engine/dynamics/motion_work.h"
#include "engine/dynamics/turned_box.h"

namespace shatterbox::dynamics {

class PathTest {
 public:
  explicit PathTest(const ContactSettings& settings, MotionWork& work) : settings_(settings), work_(work) {}

  /// Places the bodies of the pairs that are due at their ends, and looks for features that may meet.
  void prepare(const std::vector<char>& is_due);

  /// Where the pair meets, earliest first; empty if its way is free. Then ways that stay within `spare` (m)
  /// of it are free too. Different pairs may be tested at once.
  std::vector<PathHit> find_hits(std::size_t pair_number, double& spare);

 private:
  // One body in one straight part of its way.
  struct Part {
    std::vector<Vec3> to;              // |V| x 3, at its end
    Vec3 way = Vec3::Zero();           // of the centre, m
    Vec3 centre = Vec3::Zero();        // where it begins
    collision::PlacedCollider placed;  // its swept boxes
  };
  // How finely a way is divided: its straight parts are halved as often as the other body asks for.
  static constexpr int kLevels = 7;
  struct Path {
    TurnedBox box;          // about the whole way, if that is straight
    std::vector<Vec3> end;  // |V| x 3
    std::array<std::vector<Part>, kLevels>
        in_parts;  // in 1, 2, 4, ..; filled as pairs in which one turns far need
  };

  bool turns_far(const WorkPair& pair) const;
  // What is to be done for a pair.
  enum class Look : char {
    apart,     // nothing: boxes tell that its bodies do not meet
    listed,    // go through the features that were listed
    searched,  // list them first
    turning    // one of the two turns far: by parts
  };
  Look look_at(const WorkPair& pair, double& clear) const;
  void box_ways(const std::vector<char>& is_due);
  void divide(const std::vector<std::size_t>& turning);
  int level_of(const WorkPair& pair) const;
  void fill_parts(const WorkBody& body, int level, Path& path) const;
  std::vector<PathHit> test_plane(const WorkPair& pair, double& spare) const;
  std::vector<PathHit> test_solids(const WorkPair& pair) const;
  std::vector<PathHit> test_straight(WorkPair& pair, double& spare) const;
  std::vector<PathHit> test_in_parts(const WorkPair& pair, double& spare) const;

  const ContactSettings& settings_;
  MotionWork& work_;
  std::vector<Path> paths_;         // per body
  std::vector<char> in_parts_;      // per pair in which one turns far
  std::vector<Look> looks_;         // per pair
  std::vector<double> clearances_;  // per pair, m: how far its bodies surely stay apart
};

}  // namespace shatterbox::dynamics
