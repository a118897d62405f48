// What of the state is hashed, and how.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/core/hash.h"
#include "engine/world/moment.h"
#include "engine/world/state.h"

namespace shatterbox::world {

/// What moves at the end of a step (bodies, and what they, contacts and joints remember), chained to the hash
/// of the step before, so that what decides later steps beside it shows in theirs.
std::uint64_t hash_state(const MovingState& moving, long steps, std::uint64_t previous);

/// Each body's quantities on their own, with what of the pictures of stress is known.
std::vector<BodyBits> hash_bodies(const MovingState& moving, const ElementStress& element_stress);

/// What is remembered of contacts and joints.
std::uint64_t hash_contacts(const MovingState& moving);

}  // namespace shatterbox::world
