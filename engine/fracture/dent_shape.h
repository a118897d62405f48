// The shape that a dent leaves, from the displacement that its strains ask for to first order. That one
// stretches what it turns: a fibre of a plate that leans by w' is longer by w'^2 / 2, and so is the plate.
#pragma once

#include "engine/fracture/solid_model.h"

namespace shatterbox::fracture {

/// `displacement` (|dof|, m) in rounds of one solve each: every cell asks for its first-order strain turned
/// as it is turned by now (warped strains [MDMJC02]), and the solid gives what fits together. So it keeps its
/// volume within a few percent. Returns it as far as it has come where a solve fails.
VecX turn_dent_shape(const SolidModel& model, const VecX& displacement);

}  // namespace shatterbox::fracture
