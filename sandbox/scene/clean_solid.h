// A solid whose mesh is open or passes through itself gets a clean surface, where that is honest.
#pragma once

#include <string>

#include "engine/core/result.h"
#include "engine/world/world.h"

namespace shatterbox::sandbox::scene {

/// Closes the holes of a mesh with an open border (geometry/remade_surface.h). What was done, for a note; or
/// why not.
core::Result<std::string> close_holes(world::SolidDescription& solid);

/// Likewise of a closed mesh that passes through itself, the border of what is inside; an empty error if it
/// does not.
core::Result<std::string> unite_crossings(world::SolidDescription& solid);

}  // namespace shatterbox::sandbox::scene
