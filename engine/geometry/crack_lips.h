// The two sides of an open crack do not go through each other.
#pragma once

#include <vector>

#include "engine/geometry/solid_copies.h"

namespace shatterbox::geometry {

/// Where moves of the copies' vertices (m) would put the sides of a crack into each other, those meet halfway
/// and hold; what is about goes along, ever less.
void part_lips(const CopiedSolid& copied, std::vector<Vec3>& moves);

}  // namespace shatterbox::geometry
