#include "tests/structure/import_rules.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

namespace shatterbox::structure {
namespace {

struct Floor {
  const char* folder;
  int height;
};

// STYLE.md's floors: a file includes lower floors or its own folder.
constexpr std::array<Floor, 10> kFloors{{{"core", 1},
                                         {"geometry", 2},
                                         {"material", 2},
                                         {"body", 3},
                                         {"stress", 3},
                                         {"audit", 4},
                                         {"collision", 4},
                                         {"fracture", 4},
                                         {"dynamics", 5},
                                         {"world", 6}}};

int floor_of(const std::string& folder) {
  for (const Floor& floor : kFloors)
    if (folder == floor.folder) return floor.height;
  return 0;
}

/// "engine/geometry/bvh.h" -> {"engine", "geometry"}; {"", ""} for what is not ours.
std::array<std::string, 2> house_and_room(const std::string& path) {
  const std::size_t first = path.find('/');
  if (first == std::string::npos) return {};
  const std::string house = path.substr(0, first);
  if (house != "engine" && house != "render" && house != "sandbox" && house != "tests") return {};
  const std::size_t second = path.find('/', first + 1);
  return {house, second == std::string::npos ? "" : path.substr(first + 1, second - first - 1)};
}

bool begins_with(const std::string& text, const std::string& start) {
  return text.rfind(start, 0) == 0;
}

bool is_header(const std::string& path) {
  return path.ends_with(".h");
}

/// The text without comments and without what stands in them; strings are left as they are.
std::string without_comments(const std::string& text) {
  std::string result;
  for (std::size_t i = 0; i < text.size();) {
    if (text.compare(i, 2, "//") == 0) {
      i = std::min(text.find('\n', i), text.size());
    } else if (text.compare(i, 2, "/*") == 0) {
      const std::size_t end = text.find("*/", i + 2);
      i = end == std::string::npos ? text.size() : end + 2;
    } else {
      result += text[i++];
    }
  }
  return result;
}

SourceFile read_source(const std::filesystem::path& root, const std::filesystem::path& path) {
  std::ifstream stream(path);
  std::stringstream bytes;
  bytes << stream.rdbuf();
  std::istringstream text(without_comments(bytes.str()));
  SourceFile file;
  file.path = path.lexically_relative(root).generic_string();
  for (std::string line; std::getline(text, line);) {
    const std::size_t hash = line.find_first_not_of(" \t");
    if (hash == std::string::npos || line[hash] != '#') continue;
    const std::size_t word = line.find_first_not_of(" \t", hash + 1);
    if (word == std::string::npos) continue;
    if (line.compare(word, 11, "pragma once") == 0) file.has_pragma_once = true;
    if (line.compare(word, 7, "include") != 0) continue;
    const std::size_t open = line.find_first_of("\"<", word);
    if (open == std::string::npos) continue;
    const std::size_t close = line.find(line[open] == '<' ? '>' : '"', open + 1);
    if (close != std::string::npos) file.includes.push_back(line.substr(open + 1, close - open - 1));
  }
  return file;
}

/// Why `file` may not include `include`; empty if it may.
std::string find_reason(const SourceFile& file, const std::string& include) {
  const auto [house, room] = house_and_room(file.path);
  const auto [other_house, other_room] = house_and_room(include);
  const auto is_library = [&](const char* name) { return begins_with(include, name); };
  if (other_house == "tests") return "sources do not include tests";
  if (include.find("..") != std::string::npos) return "includes begin at the root";
  if (house == "engine") {
    if (other_house == "render" || other_house == "sandbox") return "engine knows neither render nor sandbox";
    for (const char* name :
         {"glm/", "GL/", "glad/", "EGL/", "libav", "nlohmann/", "toml++/", "CLI/", "assimp/", "fmt/"})
      if (is_library(name)) return std::string("engine is built without ") + name;
    if (is_library("metis.h") && room != "stress") return "METIS is the stress solver's own";
    if (other_house != "engine") return "";
    if (room == other_room) return "";
    const int height = floor_of(room);
    const int other_height = floor_of(other_room);
    if (height == 0)
      return "folder engine/" + room + " has no floor; give it one in this test and in STYLE.md";
    if (other_height == 0) return "folder engine/" + other_room + " has no floor";
    if (other_height > height) return "an arrow up: " + other_room + " stands above " + room;
    if (other_height == height) return "siblings do not include each other: " + room + " and " + other_room;
  } else if (house == "render") {
    if (other_house == "engine" || other_house == "sandbox") return "render knows neither engine nor sandbox";
    if (is_library("Eigen/")) return "Eigen stays out of render";
    // The file of the video is the only one that names FFmpeg.
    if (is_library("libav") || is_library("libsw"))
      if (file.path.find("render/output/video") != 0) return "only render/output/video* names FFmpeg";
  }
  return "";
}

}  // namespace

std::vector<SourceFile> read_sources(const std::filesystem::path& root) {
  std::vector<SourceFile> files;
  for (const char* house : {"engine", "render", "sandbox"}) {
    if (!std::filesystem::is_directory(root / house)) continue;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / house)) {
      const std::string ending = entry.path().extension().string();
      if (entry.is_regular_file() && (ending == ".h" || ending == ".cpp"))
        files.push_back(read_source(root, entry.path()));
    }
  }
  std::sort(files.begin(), files.end(),
            [](const SourceFile& a, const SourceFile& b) { return a.path < b.path; });
  return files;
}

std::vector<std::string> find_wrong_includes(const std::vector<SourceFile>& files) {
  std::vector<std::string> wrong;
  for (const SourceFile& file : files) {
    if (is_header(file.path) && !file.has_pragma_once)
      wrong.push_back(file.path + ": a header without #pragma once");
    for (const std::string& include : file.includes) {
      const std::string reason = find_reason(file, include);
      if (!reason.empty()) wrong.push_back(file.path + " includes " + include + ": " + reason);
    }
  }
  return wrong;
}

std::vector<std::string> find_circles(const std::vector<SourceFile>& files) {
  std::map<std::string, const SourceFile*> by_path;
  for (const SourceFile& file : files) by_path[file.path] = &file;
  std::vector<std::string> circles;
  std::set<std::string> finished;
  struct Visit {
    const SourceFile* file;
    std::size_t next = 0;
  };
  for (const SourceFile& start : files) {
    if (finished.count(start.path) > 0) continue;
    std::vector<Visit> path{{&start}};
    while (!path.empty()) {
      const SourceFile* file = path.back().file;
      if (path.back().next == file->includes.size()) {
        finished.insert(file->path);
        path.pop_back();
        continue;
      }
      const auto found = by_path.find(file->includes[path.back().next++]);
      if (found == by_path.end() || finished.count(found->first) > 0) continue;
      const auto earlier =
          std::find_if(path.begin(), path.end(), [&](const Visit& v) { return v.file == found->second; });
      if (earlier == path.end()) {
        path.push_back({found->second});
        continue;
      }
      std::string circle;
      for (auto v = earlier; v != path.end(); ++v) circle += v->file->path + " -> ";
      circles.push_back(circle + found->first);
    }
  }
  return circles;
}

std::vector<std::string> find_unreached(const std::filesystem::path& root,
                                        const std::vector<SourceFile>& files) {
  std::set<std::string> included;
  for (const SourceFile& file : files) included.insert(file.includes.begin(), file.includes.end());
  std::vector<std::string> unreached;
  for (const SourceFile& file : files) {
    if (is_header(file.path)) {
      if (included.count(file.path) == 0) unreached.push_back(file.path + ": no file includes this header");
      continue;
    }
    // The nearest CMakeLists.txt at or above the file's folder must name it, by a path from there.
    std::filesystem::path folder = (root / file.path).parent_path();
    while (folder != root && !std::filesystem::exists(folder / "CMakeLists.txt"))
      folder = folder.parent_path();
    std::ifstream stream(folder / "CMakeLists.txt");
    const std::string name = (root / file.path).lexically_relative(folder).generic_string();
    bool is_named = false;
    for (std::string line; std::getline(stream, line);) {
      std::istringstream words(line.substr(0, line.find('#')));
      for (std::string word; words >> word;) {
        word.erase(std::remove_if(word.begin(), word.end(), [](char c) { return c == '(' || c == ')'; }),
                   word.end());
        is_named = is_named || word == name;
      }
    }
    if (!is_named) unreached.push_back(file.path + ": no CMakeLists.txt names this file");
  }
  return unreached;
}

}  // namespace shatterbox::structure
