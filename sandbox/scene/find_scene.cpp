#include "sandbox/scene/find_scene.h"

#include <algorithm>
#include <fstream>

#include "sandbox/scene/mesh_ending.h"
#include "sandbox/scene/nearest_name.h"

namespace shatterbox::sandbox::scene {

namespace {

namespace fs = std::filesystem;

/// The scene beside a file that is not there whose name is nearest, as it is written; empty: none is near.
std::string nearest_file(const fs::path& scene) {
  const fs::path folder = scene.parent_path(), place = folder.empty() ? "." : folder;
  std::vector<std::string> stems;
  if (std::error_code code; fs::is_directory(place, code))
    for (const std::string& file : find_shots(place.string()))
      stems.push_back(fs::path(file).stem().string());
  const std::string stem = nearest_name(scene.stem().string(), stems);
  return stem.empty() ? stem : (folder / (stem + ".toml")).string();
}

}  // namespace

std::vector<fs::path> scene_folders() {
  std::vector<fs::path> folders;
  std::error_code code;
  const fs::path program = fs::read_symlink("/proc/self/exe", code).parent_path();
  const fs::path installed = program.parent_path() / "share/shatterbox/scenes";
  for (const fs::path& folder : {fs::path("scenes"), fs::path(SHATTERBOX_SCENES_DIR), installed}) {
    if (fs::is_directory(folder, code)) folders.push_back(folder);
  }
  return folders;
}

std::string first_comment(std::string_view text) {
  std::string_view line = text.substr(0, text.find('\n'));
  if (line.empty() || line.front() != '#') return {};
  line.remove_prefix(1);
  while (!line.empty() && line.front() == ' ') line.remove_prefix(1);
  while (!line.empty() && (line.back() == ' ' || line.back() == '\r')) line.remove_suffix(1);
  return std::string(line);
}

std::vector<KnownScene> known_scenes() {
  std::vector<KnownScene> scenes;
  for (const fs::path& folder : scene_folders()) {
    std::error_code code;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, code)) {
      if (entry.path().extension() != ".toml") continue;
      const std::string name = entry.path().stem().string();
      const bool is_known = std::any_of(scenes.begin(), scenes.end(),
                                        [&name](const KnownScene& scene) { return scene.name == name; });
      if (is_known) continue;
      std::ifstream stream(entry.path());
      std::string line;
      std::getline(stream, line);
      scenes.push_back({name, entry.path(), first_comment(line)});
    }
  }
  std::sort(scenes.begin(), scenes.end(),
            [](const KnownScene& a, const KnownScene& b) { return a.name < b.name; });
  return scenes;
}

std::string find_scene(const std::string& scene, Problems& problems) {
  std::error_code code;
  if (fs::is_regular_file(scene, code)) {
    if (!find_mesh_ending(scene)) return scene;
    book(problems, Place{scene, 0, 0}, "this is a mesh; a scene says what becomes of it",
         "a file of two lines does: [[body]], and mesh = \"" + scene +
             "\"; and two more for a floor: [[body]], kind = \"plane\"");
    return {};
  }
  for (const fs::path& folder : scene_folders()) {  // one of a folder's: reel/1_ornament
    const fs::path file = folder / (scene + ".toml");
    if (fs::is_regular_file(file, code)) return file.string();
  }
  std::vector<std::string> names;
  for (const KnownScene& known : known_scenes()) {
    if (known.name == scene) return known.path.string();
    names.push_back(known.name);
  }
  const std::string beside = nearest_file(scene);
  book(problems, Place{scene, 0, 0}, "there is no such scene: neither a file nor a name",
       beside.empty() ? hint_for_name(fs::path(scene).stem().string(), names, "scenes")
                      : "did you mean \"" + beside + "\"?");
  return {};
}

std::vector<std::string> find_shots(const std::string& folder) {
  std::vector<fs::path> places{folder};
  for (const fs::path& scenes : scene_folders()) places.push_back(scenes / folder);
  std::error_code code;
  std::vector<std::string> shots;
  for (const fs::path& place : places) {
    if (!fs::is_directory(place, code)) continue;
    for (const fs::directory_entry& entry : fs::directory_iterator(place, code))
      if (entry.path().extension() == ".toml") shots.push_back(entry.path().string());
    break;
  }
  std::sort(shots.begin(), shots.end());
  return shots;
}

std::vector<std::string> shots_or_scene(const std::string& scene) {
  std::vector<std::string> files = find_shots(scene);
  if (files.empty()) files.push_back(scene);
  return files;
}

}  // namespace shatterbox::sandbox::scene
