// What pairs came to in an earlier round of the same part: somebody was woken, or parted from another, and
// all others begin as they did.
#pragma once

#include <vector>

#include "engine/dynamics/contact_state.h"
#include "engine/dynamics/motion_work.h"

namespace shatterbox::dynamics {

/// Tells the pairs whose bodies both begin as they did in `earlier`, which may be empty, which of its pairs
/// is theirs. Those that cross may have been set aside since, and are none of them: none of them passes.
void match_earlier(const MotionWork& earlier, const std::vector<PairState>& states, MotionWork& work);

/// Such a pair meets as it met then, and remembers it already: moves what it came to out of `earlier`.
void take_over(WorkPair& earlier, WorkPair& pair);

}  // namespace shatterbox::dynamics
