// What the report says of an impact that was evaluated.
#pragma once

#include <string>

#include "engine/world/report.h"
#include "engine/world/verdict.h"

namespace shatterbox::world {

/// "broke: 1.3 of its strength", after a word of the caller's.
std::string format_ratio(const char* word, double ratio);

/// Its row, at `time` (s), of the body as it is.
ImpactRow describe_impact(const EvaluatedImpact& impact, const body::Body& body, double time);

}  // namespace shatterbox::world
