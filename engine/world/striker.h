// Who strikes a solid that yields, seen from that solid: its section, where and how fast it moves.
#pragma once

#include <memory>
#include <vector>

#include "engine/fracture/striker.h"
#include "engine/world/impact.h"

namespace shatterbox::world {

/// Where a part of the step began.
struct PartBegin {
  const std::vector<body::Body>& bodies;  // ascending ids
  double time = 0.0;                      // s
  double step_time = 0.0;                 // s, where the step began, from which the log counts
};

/// The body `other` as it came at `struck`, by their first collision in `log`, which is that of this part:
/// who is turned aside there, and hits again, comes at it once. Null if they did not collide, or `other` is
/// held or has no end (a plane): that has no motion of its own to spend; or is another piece of the same
/// body.
std::shared_ptr<const fracture::Striker> find_striker(const PartBegin& begin, const body::ImpulseLog& log,
                                                      body::BodyId struck, body::BodyId other);

}  // namespace shatterbox::world
