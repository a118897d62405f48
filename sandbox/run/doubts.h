// What a scene may say and yet can hardly mean: told before anybody waits for the film.
#pragma once

#include "sandbox/scene/build_world.h"
#include "sandbox/scene/problem.h"

namespace shatterbox::sandbox::run {

/// Shells nearly as thick as wide, the paper's criterion for what yields, bodies that begin in each other or
/// in the floor, a camera in a body, and throws that can meet nothing; each with its place and how to mend
/// it. `built` is at its start. What cannot be told before the run (who has moved where by then) is not.
scene::Problems find_doubts(const scene::SceneDescription& scene, const scene::BuiltScene& built);

}  // namespace shatterbox::sandbox::run
