// Whether pieces can be born where they are: a kerf cannot stand back from a crack where the material is
// thinner than rounding tells, and contact lets pairs pass that cross when they are first seen.
#pragma once

#include <vector>

#include "engine/body/body.h"
#include "engine/dynamics/contact_state.h"
#include "engine/fracture/split_solid.h"

namespace shatterbox::world {

/// Pieces whose surfaces cross or touch, where they are born, each other's or that of one of `bodies` which
/// their whole does not cross or touch (`b` is -1 then), by the same tests by which contact would find them
/// so. Numbers are those in `born`. `contact` may know colliders of the bodies; its shelf gets those that it
/// does not.
std::vector<fracture::PieceClash> find_clashes(const body::Body& whole, const std::vector<body::Body>& born,
                                               const std::vector<body::Body>& bodies,
                                               const dynamics::ContactState& contact);

}  // namespace shatterbox::world
