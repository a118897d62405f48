// Contacts of one island by temporal Gauss-Seidel: short substeps, few sweeps in each, the gap measured anew
// in every substep with exact rotations. Contacts are hard. After the positions have moved, a second set of
// sweeps takes out what the first put in to correct gaps, and what has arrived in this substep bounces. Where
// contacts are few, a substep is cut where the first of them arrives, so that hits do not know of the step.
#pragma once

#include "engine/dynamics/contact_settings.h"
#include "engine/dynamics/motion_work.h"

namespace shatterbox::dynamics {

/// Moves the bodies of `island` through the whole step. Touches only these bodies and contacts, so that
/// islands may be solved at once.
void solve_island(const ContactSettings& settings, const Island& island, MotionWork& work);

}  // namespace shatterbox::dynamics
