// The ways of pairs in which a body turns far: both are followed in as many straight parts, one after the
// other. What is known of the features near each part is kept from one test to the next.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "engine/collision/feature_list.h"
#include "engine/core/vec.h"
#include "engine/dynamics/contact_settings.h"
#include "engine/dynamics/feature_paths.h"
#include "engine/dynamics/motion_work.h"

namespace shatterbox::dynamics {

class TurningPaths {
 public:
  TurningPaths(const ContactSettings& settings, MotionWork& work) : settings_(settings), work_(work) {}

  /// Whether all that may meet on the ways of a pair was listed in a test before.
  bool is_listed(const WorkPair& pair) const;

  /// Divides the ways of the bodies in these pairs, and lists for those that are not listed the features that
  /// may meet on them. All are placed at their starts; those in pairs that are not listed, in boxes.
  void divide(const std::vector<std::size_t>& pairs);

  /// Where one of these pairs meets, in any order that is always the same. Without a hit ways that stay
  /// within `spare` (m) are free too. Different pairs may be followed at once.
  std::vector<PathHit> find_hits(std::size_t pair_number, double& spare);

 private:
  // One body in one straight part of its way.
  struct Part {
    std::vector<Vec3> to;    // |V| x 3, at its end
    collision::BodyWay way;  // of the whole body
  };
  // How finely a way is divided: its straight parts are halved as often as the other body asks for.
  static constexpr int kLevels = 7;
  using Divided = std::array<std::vector<Part>, kLevels>;  // in 1, 2, 4, ..

  bool is_followed(std::size_t pair_number) const;
  std::size_t level_of(const WorkPair& pair) const;
  void fill_parts(const WorkBody& body, std::size_t level, Divided& divided) const;
  void list_parts(WorkPair& pair) const;
  std::vector<PathHit> follow_part(const WorkPair& pair, PathMemory::Part& known, double& spare) const;

  const ContactSettings& settings_;
  MotionWork& work_;
  std::vector<Divided> bodies_;  // filled as pairs need
  std::vector<double> apart_;    // per pair, m: how far balls about its bodies stay apart, if that is enough
};

}  // namespace shatterbox::dynamics
