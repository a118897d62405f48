// The tables [camera], [light] and [render] of a scene.
#pragma once

#include "sandbox/scene/scene_description.h"
#include "sandbox/scene/toml_tree.h"

namespace shatterbox::sandbox::scene {

/// After the bodies, one of which the camera may follow.
void read_camera(const TomlValue& table, SceneDescription& scene, Problems& problems);
void read_light(const TomlValue& table, LightEntry& light, Problems& problems);
void read_render(const TomlValue& table, RenderEntry& render, Problems& problems);

}  // namespace shatterbox::sandbox::scene
