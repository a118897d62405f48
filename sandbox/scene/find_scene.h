// Scenes by path or by name.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sandbox/scene/problem.h"

namespace shatterbox::sandbox::scene {

/// A scene that can be named without its path, and its first line.
struct KnownScene {
  std::string name;
  std::filesystem::path path;
  std::string goal;
};

/// Folders where scenes are looked for: ./scenes, the one of the source tree that this program was built
/// from, and the one that is installed with it.
std::vector<std::filesystem::path> scene_folders();

/// All scenes in those folders, by name; the first folder wins.
std::vector<KnownScene> known_scenes();

/// The file that `scene` names: itself if there is such a file, else NAME.toml in a scene folder. Empty with
/// a problem that lists what there is.
std::string find_scene(const std::string& scene, Problems& problems);

/// The first line of a scene's text without its comment sign; empty if it is no comment.
std::string first_comment(std::string_view text);

/// The scenes of a folder, or of the folder of that name that came along, by their names: the shots of one
/// film. None if it is no folder.
std::vector<std::string> find_shots(const std::string& folder);

/// Those, or `scene` itself if it is no folder of scenes.
std::vector<std::string> shots_or_scene(const std::string& scene);

}  // namespace shatterbox::sandbox::scene
