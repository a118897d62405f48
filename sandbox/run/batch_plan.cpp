#include "sandbox/run/batch_plan.h"

#include <algorithm>
#include <filesystem>
#include <set>

#include <fmt/format.h>

#include "sandbox/scene/find_scene.h"

namespace shatterbox::sandbox::run {

namespace {

namespace fs = std::filesystem;

const scene::Place kSweepPlace{"--sweep", 0, 0};

/// Its scene files, or itself. Of a folder, in the order of their names.
std::vector<std::string> scenes_of(const std::string& what, scene::Problems& problems) {
  std::vector<std::string> files = scene::find_shots(what);  // of a folder, here or of those that came along
  if (!files.empty()) return files;
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

std::vector<BatchRun> plan_batch(const std::vector<std::string>& scenes, const std::vector<Sweep>& sweeps,
                                 scene::Problems& problems) {
  std::vector<BatchRun> runs;
  for (const std::string& what : scenes)
    for (const std::string& file : scenes_of(what, problems))
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
  return runs;
}

}  // namespace shatterbox::sandbox::run
