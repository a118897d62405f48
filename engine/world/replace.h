// Replace: the pieces of a broken body take its place [BHTF07] sec. VII. Mass, momentum and angular momentum
// are those of the parent because the pieces are its material; nothing is normalised. The errors are measured
// and reported.
#pragma once

#include <span>
#include <vector>

#include "engine/world/fragile.h"
#include "engine/world/report.h"
#include "engine/world/state.h"
#include "engine/world/verdict.h"

namespace shatterbox::world {

/// Takes exactly `energy` (J) out of the relative motion of the pair that met, along the load's direction, by
/// one impulse, logged as `fracture`; less if there is less. Returns what it took.
double pay_for_cracks(MovingState& moving, const EvaluatedImpact& impact, double energy,
                      body::ImpulseLog& log);

/// Puts pieces (or, if nothing came loose, the cracked shell) in place of the body of `impact`. Fills the row
/// of the report, time apart.
BreakRow replace_body(MovingState& moving, const EvaluatedImpact& impact, double time,
                      std::map<body::BodyId, Ancestry>& ancestry);

/// Where bodies of `before` broke, after the share `time` of the step, their ways end and go to `ended`, and
/// those of their pieces begin. Pieces have higher ids than all bodies before them.
void divide_ways(const std::vector<body::Body>& before, std::span<const BreakRow> breaks,
                 const std::vector<body::Body>& bodies, double time, std::vector<body::Way>& ways,
                 std::vector<body::Way>& ended);

}  // namespace shatterbox::world
