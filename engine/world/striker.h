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
};

/// The striker behind a collision of this part. Null if it came before, or from what is held or has no end (a
/// plane): that has no motion of its own to spend; or from another piece of the same body.
std::shared_ptr<const fracture::Striker> find_striker(const PartBegin& begin, body::BodyId struck,
                                                      const Load& load);

}  // namespace shatterbox::world
