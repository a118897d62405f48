// The doubts of doubts.h by what they are about; each adds its own to `doubts`.
#pragma once

#include "sandbox/scene/build_world.h"
#include "sandbox/scene/problem.h"

namespace shatterbox::sandbox::run {

/// Of a body of a world at its start.
const scene::BodyEntry& entry_of(const scene::SceneDescription& scene, const scene::BuiltScene& built,
                                 const body::Body& body);

/// What bodies are: their sizes, materials and paths.
void doubt_bodies(const scene::SceneDescription& scene, const scene::BuiltScene& built,
                  scene::Problems& doubts);

/// Where they, what joins them and the camera are.
void doubt_places(const scene::SceneDescription& scene, const scene::BuiltScene& built,
                  scene::Problems& doubts);

/// What events do with them.
void doubt_events(const scene::SceneDescription& scene, const scene::BuiltScene& built,
                  scene::Problems& doubts);

}  // namespace shatterbox::sandbox::run
