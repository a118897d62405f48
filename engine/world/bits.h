// What of the state is hashed, and how.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/core/hash.h"
#include "engine/world/moment.h"
#include "engine/world/state.h"

namespace shatterbox::world {

/// The whole state at the end of a step, chained to that of the step before.
std::uint64_t hash_state(const MovingState& moving, long steps, std::uint64_t previous);

/// Each body's quantities on their own, with what of the pictures of stress is known.
std::vector<BodyBits> hash_bodies(const MovingState& moving, const ElementStress& element_stress);

/// What is remembered of contacts and joints.
std::uint64_t hash_contacts(const MovingState& moving);

}  // namespace shatterbox::world
