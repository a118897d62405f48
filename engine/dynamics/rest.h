// Below which speeds a body counts as resting, and above which two of them collide. Both grow with gravity
// alone, so that they mean the same at every size and step.
#pragma once

#include <vector>

#include "engine/body/body.h"
#include "engine/collision/contact.h"
#include "engine/dynamics/contact_settings.h"
#include "engine/dynamics/contact_state.h"

namespace shatterbox::dynamics {

struct WorkBody;
class MotionWork;

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

/// m/s: how fast a body comes down on a sleeper where they met or meet, as it moves now.
double closing_on_sleeper(const WorkBody& mover, const collision::Contact& contact, bool sleeper_is_a);

/// Where two bodies (a pair, by its number) meet on their ways.
struct SleeperHit {
  int pair = 0;
  collision::Contact contact;
};

/// Notes in `work.to_wake` who is struck in his sleep in a step that was solved: the solver and the
/// continuous pass take him for a wall, though who strikes was set in motion only in the step. `slept`: who
/// of `bodies` slept when it began.
void find_struck_sleepers(const std::vector<body::Body>& bodies, const ContactSettings& settings,
                          const std::vector<char>& slept, const std::vector<SleeperHit>& hits,
                          MotionWork& work);

/// Wakes the sleepers named, and from neighbour to neighbour all whom the momentum could move noticeably.
void wake_struck(std::vector<body::Body>& bodies, const ContactSettings& settings, const ContactState& state,
                 const std::vector<Disturbance>& disturbances);

}  // namespace shatterbox::dynamics
