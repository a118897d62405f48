// Friction of one contact: Coulomb's, with an anchor for what it holds, and rolling friction.
#pragma once

#include "engine/core/vec.h"
#include "engine/dynamics/motion_work.h"

namespace shatterbox::dynamics {

/// What friction holds is brought back to where it was when that began, at this speed along the tangents,
/// m/s: what sweeps leave over would add up. `step` in s.
Vec2 way_back(const SolverContact& contact, double step);

/// What slides takes along the place from which it would be held, a little behind: where some contacts of a
/// pair slide and others hold, those that slide must not be in the way of what brings the others back.
void slide_on(SolverContact& contact);

/// N s: the most that friction gives on this normal impulse (N s).
double friction_bound(const SolverContact& contact, double normal_impulse);

/// By how much friction's impulse along the tangents changes, N s, against this slip (m/s) and on this normal
/// impulse (N s), in a circular cone.
Vec2 friction_change(const SolverContact& contact, const Vec2& slip, double normal_impulse);

/// Rolling friction: a couple that slows the part of the relative spin of the contact's bodies along the
/// tangents. What they roll on is a patch of about this radius, whose friction also slows the spin about the
/// normal.
void resist_rolling(SolverContact& contact, WorkBody& a, WorkBody& b);

}  // namespace shatterbox::dynamics
