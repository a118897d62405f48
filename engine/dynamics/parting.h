// Surfaces that are placed exactly in each other: a sheet on the face of a box, two sheets in one place.
// Where there is no distance there is no side to part to, and they would hang on each other.
#pragma once

#include <utility>
#include <vector>

#include "engine/body/body.h"
#include "engine/dynamics/contact_settings.h"
#include "engine/dynamics/contact_state.h"

namespace shatterbox::dynamics {

class MotionWork;

/// Of each such pair that is seen for the first time, sets one body aside, at rest as it is, by a hundred
/// thousandth of its size: out of a solid, else against gravity, else wherever it meets nobody; a pair that
/// nowhere does (a ball in its like) may pass, as those that cross. Appends the pairs that were parted, the
/// one that was set aside last, and `moved`: all that were, for some go along. True if anything was done:
/// then candidate pairs must be found anew.
bool part_coincident(std::vector<body::Body>& bodies, const ContactSettings& settings, ContactState& state,
                     const MotionWork& work, std::vector<std::pair<body::BodyId, body::BodyId>>& parted,
                     std::vector<body::BodyId>& moved);

}  // namespace shatterbox::dynamics
