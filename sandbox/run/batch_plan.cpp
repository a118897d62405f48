#include "sandbox/run/batch_plan.h"

#include <algorithm>
#include <filesystem>
#include <set>

#include <fmt/format.h>

#include "sandbox/scene/find_scene.h"
#include "sandbox/scene/read_scene.h"

namespace shatterbox::sandbox::run {

namespace {

namespace fs = std::filesystem;

const scene::Place kSweepPlace{"--sweep", 0, 0};

/// How long it says that it takes. What is wrong with it is told by its run.
std::string takes_of(const std::string& file) {
  scene::Problems ignored;
  const auto scene = scene::read_scene_file(file, {}, ignored);
  return scene ? scene->takes : std::string();
}

/// Its scene files, or itself. Of a folder, in the order of their names, without those that take long and
/// that `with` does not name.
std::vector<std::string> scenes_of(const std::string& what, const std::vector<std::string>& with,
                                   std::vector<LeftOut>& left_out, scene::Problems& problems) {
  std::vector<std::string> files = scene::find_shots(what);  // of a folder, here or of those that came along
  if (!files.empty()) {
    std::erase_if(files, [&](const std::string& file) {
      const std::string name = fs::path(file).stem().string();
      if (std::find(with.begin(), with.end(), name) != with.end()) return false;
      const std::string takes = takes_of(file);
      if (!takes.empty()) left_out.push_back({name, takes});
      return !takes.empty();
    });
    return files;
  }
  scene::Problems own;
  const std::string file = scene::find_scene(what, own);
  if (!file.empty()) return {file};
  std::error_code code;
  if (fs::is_directory(what, code)) own.clear();
  for (scene::Problem& problem : own) problems.push_back(std::move(problem));
  if (own.empty())
    scene::book(problems, scene::Place{what, 0, 0}, "there is no scene (.toml) in this folder");
  return {};
}

constexpr std::size_t kLongestName = 120;

/// Letters that file names may hold everywhere.
std::string in_file_name(const std::string& text) {
  std::string name;
  for (const char c : text) {
    const bool is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                          c == '.' || c == '-' || c == '_' || c == '=';
    if (is_plain)
      name += c;
    else if (c != '"' && c != '\'' && !name.empty() && name.back() != '-')
      name += '-';
  }
  while (!name.empty() && name.back() == '-') name.pop_back();
  return name;
}

}  // namespace

Sweep parse_sweep(const std::string& text, scene::Problems& problems) {
  Sweep sweep;
  const std::size_t equals = text.find('=');
  sweep.key = text.substr(0, equals);
  std::string value;
  int depth = 0;
  char quote = 0;
  for (std::size_t i = equals == std::string::npos ? text.size() : equals + 1; i < text.size(); ++i) {
    const char c = text[i];
    if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '[' || c == '{') {
      ++depth;
    } else if (c == ']' || c == '}') {
      --depth;
    } else if (c == ',' && depth == 0) {
      sweep.values.push_back(std::exchange(value, {}));
      continue;
    }
    value += c;
  }
  sweep.values.push_back(value);
  const bool has_gap = std::any_of(sweep.values.begin(), sweep.values.end(), [](const std::string& v) {
    return v.find_first_not_of(' ') == std::string::npos;
  });
  if (sweep.key.find('.') == std::string::npos || has_gap || depth != 0 || quote != 0)
    scene::book(problems, kSweepPlace, fmt::format("\"{}\" is no key with values", text),
                "write NAME.key=value,value,..., the values as in TOML: throw.speed=5,10");
  return sweep;
}

BatchPlan plan_batch(const std::vector<std::string>& scenes, const std::vector<Sweep>& sweeps,
                     const std::vector<std::string>& with, scene::Problems& problems) {
  BatchPlan plan;
  std::vector<BatchRun>& runs = plan.runs;
  for (const std::string& what : scenes)
    for (const std::string& file : scenes_of(what, with, plan.left_out, problems))
      runs.push_back({in_file_name(fs::path(file).stem().string()), fs::absolute(file).string(), {}});
  for (const Sweep& sweep : sweeps) {
    std::vector<BatchRun> wider;
    for (const BatchRun& run : runs) {
      for (const std::string& value : sweep.values) {
        BatchRun& next = wider.emplace_back(run);
        next.values.emplace_back(sweep.key, value);
        next.name = fmt::format("{}_{}={}", run.name, in_file_name(sweep.key), in_file_name(value));
      }
    }
    runs = std::move(wider);
  }
  std::set<std::string> names;
  for (BatchRun& run : runs) {  // two scenes of one name, in two folders
    const std::string plain = run.name.substr(0, kLongestName);
    run.name = plain;
    for (int i = 2; !names.insert(run.name).second; ++i) run.name = fmt::format("{}_{}", plain, i);
  }
  for (const std::string& name : with) {
    const bool is_there = std::any_of(runs.begin(), runs.end(), [&name](const BatchRun& run) {
      return fs::path(run.scene).stem().string() == name;
    });
    if (!is_there)
      scene::book(problems, scene::Place{"--with", 0, 0},
                  fmt::format("no scene of these folders is called \"{}\"", name),
                  "give the name of its file without .toml");
  }
  return plan;
}

}  // namespace shatterbox::sandbox::run
