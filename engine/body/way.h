// How bodies went through a step, where that was not straight from its start to its end.
#pragma once

#include <memory>
#include <vector>

#include "engine/body/body.h"
#include "engine/core/vec.h"

namespace shatterbox::body {

/// A pose within a step, at this share of it. Between two of them, and the step's ends, vertices go straight.
struct Waypoint {
  double time = 0.0;
  Pose pose;
};

struct Way {
  BodyId id = 0;
  std::vector<Waypoint> points;  // ascending in time, within (0, 1), `begin` and `end` included
  // Shares of the step: where the body came to be in its present shape, and where it broke.
  double begin = 0.0, end = 1.0;
  std::shared_ptr<const Body> former = nullptr;  // of one that broke: as it was
};

}  // namespace shatterbox::body
