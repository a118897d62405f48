// Contacts of one pair at the start of the step, and where it will first touch on the way that it would take
// freely.
#pragma once

#include "engine/dynamics/contact_settings.h"
#include "engine/dynamics/contact_state.h"
#include "engine/dynamics/motion_work.h"

namespace shatterbox::dynamics {

/// Fills contacts, lists and the kept gap of a classified `pair`; its bodies must be placed and their boxes
/// fitted. Writes to this pair and its memory only, so that pairs may be treated at once.
void find_pair_contacts(const ContactSettings& settings, const MotionWork& work, PairState& memory,
                        WorkPair& pair);

/// The same of a pair that begins as it did when the part was taken before.
void meet_again(const ContactSettings& settings, const PartMemory::Pair& former, const MotionWork& work,
                PairState& memory, WorkPair& pair);

}  // namespace shatterbox::dynamics
