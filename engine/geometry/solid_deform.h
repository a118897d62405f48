// A solid's material moved along with its elements' vertices: what was flat over several elements is no
// longer, and its surface gets a facet an element there.
#pragma once

#include <vector>

#include "engine/geometry/solid_complex.h"

namespace shatterbox::geometry {

struct DeformedSolid {
  SolidComplex complex;          // settled; elements of its own, of the same numbers
  std::vector<int> tag_sources;  // per tag of its outer facets: the tag that it had
};

/// `piece`: settled. `moves`: |vertices of the element mesh|, m. Elements with cells must keep a volume. What
/// is left of a given triangle falls into parts that are flat but for `flatness` m to both sides.
DeformedSolid deform(const SolidComplex& piece, const std::vector<Vec3>& moves, double flatness);

/// Volume of each element after the moves as a share of what it was, the least over elements with cells.
double least_volume_share(const SolidComplex& piece, const std::vector<Vec3>& moves);

/// Volume of all material after the moves as a share of what it was.
double volume_share(const SolidComplex& piece, const std::vector<Vec3>& moves);

}  // namespace shatterbox::geometry
