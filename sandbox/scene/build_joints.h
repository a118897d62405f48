// [[joint]] -> the world's joints, once its bodies are there.
#pragma once

#include "sandbox/scene/build_world.h"

namespace shatterbox::sandbox::scene {

/// Joins the bodies of `built`. Mortar that finds no faces to hold is a problem.
void add_joints(const SceneDescription& scene, BuiltScene& built, Problems& problems);

}  // namespace shatterbox::sandbox::scene
