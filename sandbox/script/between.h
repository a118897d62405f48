// The world between two steps, for films that show less than a step a frame. Pictures only: nothing here goes
// back into the world.
#pragma once

#include <span>
#include <vector>

#include "engine/world/world.h"

namespace shatterbox::sandbox::script {

/// The bodies of `before` on their way to where they are after the step that `world` has just taken; `share`
/// (0 to 1) of it is over. A body that broke in the step goes with its heaviest piece, whole: pieces are
/// there from the step's end on.
std::vector<body::Body> bodies_between(std::span<const body::Body> before, const world::World& world,
                                       double share);

}  // namespace shatterbox::sandbox::script
