// A body that is gone through: what its hole takes from the striker, how a plug comes along, and what is
// left [RI63].
#pragma once

#include <optional>
#include <span>
#include <string>

#include "engine/dynamics/step_motion.h"
#include "engine/world/replace.h"

namespace shatterbox::world {

/// What was asked of the impact's striker; null: nobody comes near to going through.
const fracture::Perforation* find_perforation(const EvaluatedImpact& impact);

/// The hole through which the impact's striker goes, or null.
const fracture::Perforation* find_hole(const EvaluatedImpact& impact);

/// s: when striker and plug are out of the hole, and what they meet is another hit.
double time_behind(const fracture::Perforation& hole);

/// Whether the break of this impact waits for the next pass: its striker breaks itself in this one, or goes
/// through another body first.
bool waits_for_striker(const EvaluatedImpact& impact, std::span<const EvaluatedImpact> impacts);

/// A finer division of the step (which began at `begin` s and lasts `step` s) in which a part begins just
/// before a striker arrives who goes through: what a break takes from a striker it takes at the begin of a
/// part, and it must not slow down, or a plug go, before they have met. None if no part needs it.
std::optional<dynamics::StepPart> divide_before_holes(std::span<const EvaluatedImpact> impacts,
                                                      const dynamics::StepPart& part, double begin,
                                                      double step);

/// Takes what the hole needs out of the striker's motion against the body, along it, by one impulse through
/// the striker's centre, logged as `fracture`.
void pay_for_hole(MovingState& moving, const EvaluatedImpact& impact, body::ImpulseLog& log);

/// Lets striker and plug (what of the pieces is inside the hole) go on together: perfectly inelastic,
/// momentum kept, logged.
void take_plug_along(MovingState& moving, const EvaluatedImpact& impact, const BreakRow& row,
                     body::ImpulseLog& log);

/// Leaves what stays of the body, once striker and plug are out of the hole, the dent about it; if the body
/// `keeps_dents`, which goes on to what stays.
void leave_dent(MovingState& moving, const EvaluatedImpact& impact, const BreakRow& row, bool keeps_dents);

/// "perforated: 1.4 times the energy it takes", or what of that energy there was.
std::string describe_perforation(const fracture::Perforation& perforation);

}  // namespace shatterbox::world
