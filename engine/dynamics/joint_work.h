// Joints within one step: who is joined, what they gave, and what goes to the log and the state.
#pragma once

#include <utility>
#include <vector>

#include "engine/body/impulse_log.h"
#include "engine/core/disjoint_sets.h"
#include "engine/dynamics/contact_state.h"
#include "engine/dynamics/motion_work.h"

namespace shatterbox::dynamics {

/// Fills `work.joints` with those of whom both bodies are there and one can move. Bodies must be there.
void list_joints(const ContactState& state, MotionWork& work);

/// True of two bodies that touch about a point about which they turn: they have no contact.
bool share_pivot(const MotionWork& work, int a, int b);

/// Takes the contacts from pairs that hold together: what presses on a joint is the joint's. They are kept
/// from crossing like all others.
void forget_joined_contacts(MotionWork& work);

/// How far the faces that a joint holds are from where they should be at the bodies' ends, m, at most.
double off_at_end(const WorkJoint& joint, const MotionWork& work);

/// Bodies that move as one, by mortar: what no impulse moves joins nobody.
core::DisjointSets join_bodies(const MotionWork& work);

/// Appends what joints gave: four forces at the corners of a rectangle that has the area's moments, which
/// together are the joint's force and couple.
void log_joints(const MotionWork& work, body::ImpulseLog& log);

/// Writes what joints gave to the state, and how fast they swing what they pull.
void remember_joints(const MotionWork& work, ContactState& state);

/// How fast, rad/s, what arrives within `time_step` (s) would swing the links that it strikes, at most.
double find_swing_by_blows(const std::vector<body::Body>& bodies, const MotionWork& work, double time_step);

/// The most that a joint is off at the ends of the ways, of the lesser reach: what was opened tears it.
double find_torn(const MotionWork& work);

}  // namespace shatterbox::dynamics
