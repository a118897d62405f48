// From contacts of pairs to the solver's contacts, and to islands of bodies that they join.
#pragma once

#include "engine/dynamics/contact_state.h"
#include "engine/dynamics/motion_work.h"

namespace shatterbox::dynamics {

/// Fills `work.contacts` and `work.islands` from the pairs' contacts.
void build_contact_graph(const ContactState& state, MotionWork& work);

/// Joins bodies to islands by `work.contacts`; bodies in them are not free.
void build_islands(MotionWork& work);

/// The solver's form of a pair's contact, with what is remembered of it.
SolverContact make_solver_contact(const PairState& memory, const MotionWork& work, int pair_number,
                                  const collision::Contact& found);

}  // namespace shatterbox::dynamics
