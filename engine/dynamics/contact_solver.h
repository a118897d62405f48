// Contacts of one island by temporal Gauss-Seidel: short substeps, few sweeps in each, the gap measured anew
// in every substep with exact rotations. Contacts are hard. After the positions have moved, a second set of
// sweeps takes out what the first put in to correct gaps, and what has arrived in this substep bounces. Where
// contacts are few, a substep is cut where the first of them arrives, so that hits do not know of the step.
#pragma once

#include "engine/dynamics/contact_settings.h"
#include "engine/dynamics/motion_work.h"

namespace shatterbox::dynamics {

/// Of at most so many contacts a substep is cut where the first arrives.
inline constexpr std::size_t kFewContacts = 64;

/// True if a hit runs on through what touches, one after the other: where contacts are few, all bodies are
/// spheres, boxes, capsules and planes, and those that joints hold hang on points of something that stands
/// still. What may break is judged by all that a step's hit brings together.
bool strikes_one_by_one(const Island& island, const MotionWork& work);

/// Moves the bodies of `island` through the whole step. Touches only these bodies and contacts, so that
/// islands may be solved at once.
void solve_island(const ContactSettings& settings, const Island& island, MotionWork& work);

}  // namespace shatterbox::dynamics
