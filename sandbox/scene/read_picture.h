// The tables [camera], [light] and [render] of a scene.
#pragma once

#include "sandbox/scene/scene_description.h"
#include "sandbox/scene/toml_tree.h"

namespace shatterbox::sandbox::scene {

void read_camera(const TomlValue& table, CameraEntry& camera, Problems& problems);
void read_light(const TomlValue& table, LightEntry& light, Problems& problems);
void read_render(const TomlValue& table, RenderEntry& render, Problems& problems);

}  // namespace shatterbox::sandbox::scene
