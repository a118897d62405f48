// Stage "evaluate stress": which bodies do the logged impulses break? Pure but for the memories of impacts.
#pragma once

#include <map>
#include <variant>
#include <vector>

#include "engine/body/impulse_log.h"
#include "engine/dynamics/contact_settings.h"
#include "engine/world/fragile.h"
#include "engine/world/impact.h"
#include "engine/world/settings.h"
#include "engine/world/striker.h"

namespace shatterbox::world {

/// The answer for one body whose impact was evaluated.
struct EvaluatedImpact {
  body::BodyId id = 0;
  double first_time = 0.0;    // s, of the first impulse of the event
  Load hardest;               // body space
  double charged = 0.0;       // N s, of all loads by whose is the hardest
  bool is_struck = false;     // by a collision; otherwise contact alone pressed
  bool has_used_all = false;  // generations that one event has: it holds, whatever the stress
  std::variant<fracture::Decision, fracture::SolidDecision> decision;

  /// Of a solid: it has cracks, and yet all of it hangs together.
  bool is_cracked_only() const {
    const auto* solid = std::get_if<fracture::SolidDecision>(&decision);
    return solid && solid->verdict.outcome == fracture::Outcome::broke && solid->part_count == 1;
  }

  const fracture::DecisionFigures& figures() const {
    return std::visit([](const auto& d) -> const fracture::DecisionFigures& { return d; }, decision);
  }
};

struct EvaluationFigures {
  long solves = 0, skipped = 0, factorisations = 0;
  double worst_residual = 0.0;
};

/// An impact that a body has borne in an earlier pass of the same step.
struct BorneImpact {
  std::vector<Load> loads;   // collisions and contact
  double most_growth = 0.0;  // so many times these loads are borne without another solve
  // What the body's memory keeps of the verdict.
  double duration = 0.0;  // s; 0: nothing struck
  double tested_growth = 1.1;
  bool had_used_all = false;  // generations
};
using BorneImpacts = std::map<body::BodyId, BorneImpact>;

/// N: under what rests on it, up to so much in all, the body surely does not break, as far as is known.
double borne_at_rest(const body::Body& body, const Fragile& fragile, const ImpactMemory& memory);

/// Reads the log of a part of the step that begins at `time` (s); writes event sums to `memories`; returns
/// the impacts that were evaluated, ascending by body. An impact like one that the body has `borne` in an
/// earlier pass of the step is not solved again. Bodies are evaluated in parallel; the answer does not depend
/// on it. With `begin`, the begin of that part, strikers may go through what yields.
std::vector<EvaluatedImpact> evaluate_stress(const std::vector<body::Body>& bodies,
                                             const body::ImpulseLog& log, const Fragiles& fragiles,
                                             const WorldSettings& settings,
                                             const dynamics::ContactSettings& contact, double time,
                                             std::map<body::BodyId, ImpactMemory>& memories,
                                             BorneImpacts& borne, EvaluationFigures& figures,
                                             const PartBegin* begin = nullptr);

}  // namespace shatterbox::world
