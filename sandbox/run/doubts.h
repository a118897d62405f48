// What a scene may say and yet can hardly mean: told before anybody waits for the film.
#pragma once

#include "sandbox/scene/build_world.h"
#include "sandbox/scene/problem.h"

namespace shatterbox::sandbox::run {

/// Shells nearly as thick as wide, things of a household as large as a house, the paper's criterion for what
/// yields, bodies that begin in each other or in the floor, or stand in each other and would sink into one,
/// tables that would fall with what is on them, a camera in a body, and throws that can meet nothing; each
/// with its place and how to mend it. `built` is at its start. What cannot be told before the run (who has
/// moved where by then) is not.
scene::Problems find_doubts(const scene::SceneDescription& scene, const scene::BuiltScene& built);

/// After a run: solids that were stressed beyond their strength and held because no crack could start in
/// elements as large as theirs, or of a material as tough, of copies the hardest hit; and a scene in which
/// all fell and met nothing.
scene::Problems find_afterthoughts(const scene::SceneDescription& scene, const scene::BuiltScene& built);

}  // namespace shatterbox::sandbox::run
