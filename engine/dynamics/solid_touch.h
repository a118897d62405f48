// When and where two solids (spheres, boxes) first touch on their way through a step, by conservative
// advancement: along separating directions that stand still, and with faces that go along with their bodies.
#pragma once

#include <vector>

#include "engine/collision/contact.h"
#include "engine/dynamics/motion_work.h"

namespace shatterbox::dynamics {

/// One body on a straight part of its way, or between two shares of it: who turns less has longer parts.
struct SolidWay {
  const WorkBody& body;
  Pose from, to;  // of the whole part: its points go straight
  double begin = 0.0, end = 1.0;

  /// At a share of what is followed.
  Pose pose_at(double time) const { return blend(from, to, begin + time * (end - begin)); }
};

struct SolidTouch {
  bool has_touched = false;
  double time = 1.0;                         // share of the way
  double knot = 1.0;                         // the same, where the contacts are to be open
  std::vector<collision::Contact> contacts;  // seen from the start of the step; empty if they do not touch
};

/// Follows both bodies until their gap is `least` (m, below the present one); contacts are those with gaps
/// below `margin` (m) then.
SolidTouch find_first_touch(const SolidWay& a, const SolidWay& b, double least, double margin);

}  // namespace shatterbox::dynamics
