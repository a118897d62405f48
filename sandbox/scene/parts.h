// What there is now of a body of the scene: itself, its copies, and all their pieces.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "sandbox/scene/build_world.h"

namespace shatterbox::sandbox::scene {

/// Where a body, or what it is a piece of, came from; null: from nowhere in the scene.
const Origin* origin_of(const BuiltScene& built, body::BodyId id);

/// Those of `bodies` (of the world of `built`, at some time) that are `who` or came from it.
std::vector<const body::Body*> parts_of(const BuiltScene& built, std::span<const body::Body> bodies,
                                        BodyRef who);

/// Where it is: its centre of mass, or that of all its pieces, m. Nothing if it is not there.
std::optional<Vec3> centre_of(const BuiltScene& built, std::span<const body::Body> bodies, BodyRef who);

/// Its momentum over its mass, m/s; zero if it is not there or has no mass.
Vec3 velocity_of(const BuiltScene& built, std::span<const body::Body> bodies, BodyRef who);

}  // namespace shatterbox::sandbox::scene
