// The GLSL texts of this folder, as they were when the binary was built.
#pragma once
#include <string_view>

namespace shatterbox::shaders {

// The text of "surface.frag", "common/light.glsl", ...; empty when there is none of that name.
std::string_view find_shader(std::string_view name);

}  // namespace shatterbox::shaders
