// The lowest frequency of a shell that is not a rigid motion: subspace iteration with four vectors on a
// factor.
#pragma once

#include <functional>
#include <vector>

#include "engine/core/vec.h"
#include "engine/stress/shell_structure.h"

namespace shatterbox::stress {

/// Square of the lowest frequency in units of the shell, from above, to about 1 %. `precondition` solves with
/// the factor and takes rigid motions out.
double first_frequency_squared(
    const ShellStructure& structure,
    const std::function<std::vector<VecX>(const std::vector<const VecX*>&)>& precondition);

}  // namespace shatterbox::stress
