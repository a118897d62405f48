// The lowest frequency of a solid that is not a rigid motion, by Lanczos' recurrence from a random motion:
// about as many products with the stiffness as a solve to three digits takes, and no solve.
#pragma once

#include "engine/stress/block_gradients.h"
#include "engine/stress/rigid_modes.h"

namespace shatterbox::stress {

/// Square of the lowest frequency of K x = w^2 M x, units of the solid, to about 1 %, from above; 0 if
/// nothing can move but as a whole. `mass`: |dof|; only `rows` and `holds` of the system are read.
double lowest_frequency_squared(const BlockSystem& system, const VecX& mass, const RigidModes& rigid);

}  // namespace shatterbox::stress
