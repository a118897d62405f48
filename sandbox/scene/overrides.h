// --set NAME.key=value: changes to a scene's TOML tree before it is checked, so that a wrong change is told
// in the same words as a wrong scene.
#pragma once

#include <string>

#include "sandbox/scene/toml_tree.h"

namespace shatterbox::sandbox::scene {

/// The name under which a [[body]], [[material]], [[joint]] or [[event]] (`kind`) can be named: its own, or
/// kind and number ("body2") where it has none. `index` counts from 0.
std::string name_or_number(const TomlValue& table, const std::string& kind, std::size_t index);

/// Changes `scene` as `NAME.key=value` or `NAME.key.key=value` says. NAME is scene, camera, light, render or
/// a named body, material, joint or event; value is TOML. Tables that are missing on the way are made. Faults
/// add problems.
void apply_override(TomlValue& scene, const std::string& change, Problems& problems);

}  // namespace shatterbox::sandbox::scene
