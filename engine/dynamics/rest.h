// Below which speeds a body counts as resting, and above which two of them collide. Both grow with gravity
// alone, so that they mean the same at every size and step.
#pragma once

#include <vector>

#include "engine/body/body.h"
#include "engine/dynamics/contact_settings.h"
#include "engine/dynamics/contact_state.h"

namespace shatterbox::dynamics {

/// Closing speed, m/s, that resting contact never reaches: what gravity gives within two steps, and over a
/// few gaps.
double impact_threshold(const ContactSettings& settings, double kept_gap);

/// True if no point of a body of this `reach` (m) moves noticeably.
bool is_quiet(const ContactSettings& settings, const Vec3& velocity, const Vec3& spin, double reach);

/// Wakes a sleeping body and all that sleep in its island.
void wake_island(std::vector<body::Body>& bodies, const ContactState& state, body::Body& sleeper);

}  // namespace shatterbox::dynamics
