// Decide, and cut: does a striker go through a solid that yields? The plug is cut out along his motion and
// widens towards the exit: planes alone, so the elements do not matter, nothing binds, and what leaves has
// room.
#pragma once

#include <memory>
#include <optional>

#include "engine/fracture/perforation.h"

namespace shatterbox::fracture {

struct SolidHole : Perforation {
  std::shared_ptr<const geometry::SolidComplex> complex;  // cut, settled; null: he is far
};

/// Of a striker that is far (ask_for_hole), or whose way is open but for what is narrower than `least_width`
/// m, only that is said. Nothing where the law does not tell: his plug would be more than what is left, or
/// his line parts nothing. `tag` is that of the new crack facets.
std::optional<SolidHole> find_perforation(const geometry::SolidComplex& complex,
                                          const material::Material& material, const Striker& striker,
                                          double least_width, int tag);

}  // namespace shatterbox::fracture
