// Which bodies may meet in a step: by axis-aligned boxes over their ways, then by boxes that turn with them.
#pragma once

#include <vector>

#include "engine/body/body.h"
#include "engine/dynamics/contact_settings.h"
#include "engine/dynamics/motion_work.h"

namespace shatterbox::dynamics {

struct FoundPair {
  int a = 0, b = 0;           // numbers of the bodies, a < b
  double clearance = -1e300;  // m: a bound of how far apart they stay if they end where they were looked for
};

/// Looks at the way to `end` and what is about it.
void look_about(const ContactSettings& settings, const Pose& end, WorkBody& body);

/// Whether all that the body meets on its way to its end was found from where it was looked for.
bool is_within_looked(const ContactSettings& settings, const WorkBody& body);

/// All pairs that may meet if their bodies end within their reserves of where they were looked for,
/// ascending; only those with a body that `is_wanted` (per body).
std::vector<FoundPair> find_pairs(const std::vector<body::Body>& bodies, const MotionWork& work,
                                  const std::vector<char>& is_wanted);

}  // namespace shatterbox::dynamics
