// TOML text -> SceneDescription. Every fault of the text is told at once, each with its place.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sandbox/scene/scene_description.h"

namespace shatterbox::sandbox::scene {

/// Changes from the command line, applied before checking.
struct SceneChanges {
  std::vector<std::string> overrides;  // NAME.key=value
  std::string script_file;             // a file of [[event]]; empty: none
};

/// The scene of a text; `file` names it in complaints, and relative mesh files are looked for beside it.
/// Nothing if `problems` got any.
std::optional<SceneDescription> read_scene(std::string_view text, const std::string& file,
                                           const SceneChanges& changes, Problems& problems);

/// The same for a file.
std::optional<SceneDescription> read_scene_file(const std::string& file, const SceneChanges& changes,
                                                Problems& problems);

}  // namespace shatterbox::sandbox::scene
