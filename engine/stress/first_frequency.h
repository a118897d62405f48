// The lowest frequency of a shell that is not a rigid motion: subspace iteration with four vectors on a
// factor.
#pragma once

#include <functional>
#include <vector>

#include "engine/core/vec.h"
#include "engine/stress/shell_structure.h"

namespace shatterbox::stress {

struct FrequencyEstimate {
  double squared = 0.0;   // units of the shell; from above
  double previous = 0.0;  // the same one step earlier
};

/// Square of the lowest frequency after at most `steps` steps, or when a step changes it by less than 0.5 %.
/// `precondition` solves with the factor and takes rigid motions out.
FrequencyEstimate first_frequency(
    const ShellStructure& structure,
    const std::function<std::vector<VecX>(const std::vector<const VecX*>&)>& precondition, int steps);

}  // namespace shatterbox::stress
