// One [[joint]]: who is held together, and how firmly.
#pragma once

#include "sandbox/scene/scene_description.h"
#include "sandbox/scene/toml_tree.h"

namespace shatterbox::sandbox::scene {

/// Reads it, checks it against the bodies of `scene`, which must be there, and adds it.
void read_joint(const TomlValue& table, std::size_t index, SceneDescription& scene, Problems& problems);

}  // namespace shatterbox::sandbox::scene
