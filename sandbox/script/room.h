// Is there room where a body would come in? Nothing that crosses another at its birth can be kept apart from
// it afterwards.
#pragma once

#include <string>

#include "engine/world/world.h"

namespace shatterbox::sandbox::script {

/// The name of a body of `world` that a new body would cross or be inside of at its own pose, the one with
/// the least number if there are several; empty if there is room. Bodies of its own group are not in its way,
/// nor is what it is inside of when that is a shell: shells have no inside.
std::string find_obstacle(const world::World& world, const world::BodyDescription& description);

/// Whether two bodies lie in each other by more than a hundredth of their size: what only touches does not.
bool lie_in_each_other(const body::Body& a, const body::Body& b);

/// Whether a point (m, world) is inside a body; of a shell, if that is all round it.
bool holds(const body::Body& body, const Vec3& point);

}  // namespace shatterbox::sandbox::script
