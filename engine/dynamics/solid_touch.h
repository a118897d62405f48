// When and where two solids (spheres, boxes) first touch on their way through a step, by conservative
// advancement.
#pragma once

#include <vector>

#include "engine/collision/contact.h"
#include "engine/dynamics/motion_work.h"

namespace shatterbox::dynamics {

struct SolidTouch {
  double time = 1.0;                         // share of the step
  std::vector<collision::Contact> contacts;  // seen from the start of the step; empty if they do not touch
};

/// Follows both bodies from their starts to the end poses, straight and turning the short way, until their
/// gap is `least` (m); contacts are those with gaps below `margin` (m) then.
SolidTouch find_first_touch(const WorkBody& a, const Pose& end_a, const WorkBody& b, const Pose& end_b,
                            double least, double margin);

}  // namespace shatterbox::dynamics
