// The form of a shell or a solid: a mesh from files, or a shape with sizes.
#pragma once

#include <string>
#include <vector>

#include "sandbox/scene/scene_description.h"
#include "sandbox/scene/table_reader.h"

namespace shatterbox::sandbox::scene {

/// Keys that give a shape its sizes.
const std::vector<std::string>& shape_keys();

/// Reads mesh or shape, sizes, scale, thickness; every fault is told to the reader.
ShellForm read_shell(TableReader& reader, const SceneDescription& scene);
SolidForm read_solid(TableReader& reader, const SceneDescription& scene);

}  // namespace shatterbox::sandbox::scene
