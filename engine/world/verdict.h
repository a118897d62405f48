// Stage "evaluate stress": which bodies do the logged impulses break? Pure but for the memories of impacts.
#pragma once

#include <map>
#include <vector>

#include "engine/body/impulse_log.h"
#include "engine/dynamics/contact_settings.h"
#include "engine/world/fragile.h"
#include "engine/world/impact.h"
#include "engine/world/settings.h"

namespace shatterbox::world {

/// The answer for one body whose impact was evaluated.
struct EvaluatedImpact {
  body::BodyId id = 0;
  double first_time = 0.0;  // s, of the first impulse of the event
  Load hardest;             // body space
  fracture::Decision decision;
};

struct EvaluationFigures {
  long solves = 0, skipped = 0, factorisations = 0;
  double worst_residual = 0.0;
};

/// Reads the log of the step that begins at `time` (s); writes event sums to `memories`; returns the impacts
/// that were evaluated, ascending by body. Bodies are evaluated in parallel; the answer does not depend on
/// it.
std::vector<EvaluatedImpact> evaluate_stress(const std::vector<body::Body>& bodies,
                                             const body::ImpulseLog& log, const Fragiles& fragiles,
                                             const WorldSettings& settings,
                                             const dynamics::ContactSettings& contact, double time,
                                             std::map<body::BodyId, ImpactMemory>& memories,
                                             EvaluationFigures& figures);

}  // namespace shatterbox::world
