// Whether a surface that is shifted by next to nothing goes through another one that it touches: by exact
// sides, since gaps there are less than rounding.
#pragma once

#include "engine/collision/feature_list.h"

namespace shatterbox::dynamics {

/// `before` and `after`: one collider, that far (m) apart. What lies exactly in the other surface has no
/// side, and goes through nothing.
bool goes_through(const collision::PlacedCollider& before, const collision::PlacedCollider& after,
                  const collision::PlacedCollider& other, double distance);

}  // namespace shatterbox::dynamics
