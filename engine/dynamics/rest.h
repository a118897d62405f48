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

/// At most this fast, m/s, is any point of a body of this `reach` (m).
double greatest_speed(const Vec3& velocity, const Vec3& spin, double reach);

/// True if no point of a body of this `reach` (m) moves noticeably.
bool is_quiet(const ContactSettings& settings, const Vec3& velocity, const Vec3& spin, double reach);

/// Whether a body that moves, or may begin to, has the momentum to make a sleeper move noticeably.
bool could_move(const ContactSettings& settings, const body::Body& mover, const body::Body& sleeper);

/// Something that comes upon a sleeper.
struct Disturbance {
  body::BodyId body = 0;  // the sleeper
  double momentum = 0.0;  // kg m/s: what goes on to others; infinite of what no impulse moves
};

/// Wakes the sleepers named, and from neighbour to neighbour all whom the momentum could move noticeably.
void wake_struck(std::vector<body::Body>& bodies, const ContactSettings& settings, const ContactState& state,
                 const std::vector<Disturbance>& disturbances);

}  // namespace shatterbox::dynamics
