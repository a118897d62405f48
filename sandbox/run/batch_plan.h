// What a batch runs: scenes times values.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "sandbox/scene/problem.h"

namespace shatterbox::sandbox::run {

/// "ball.speed=5,10" : a key of a scene and the values that it takes in turn.
struct Sweep {
  std::string key;
  std::vector<std::string> values;  // as in TOML
};

/// Commas part values, but not within brackets, braces or quotes. Nothing to sweep goes to `problems`.
Sweep parse_sweep(const std::string& text, scene::Problems& problems);

struct BatchRun {
  std::string name;  // of its folder: scene and values
  std::string scene;
  std::vector<std::pair<std::string, std::string>> values;  // of the sweeps
};

/// A scene of a folder that says itself that it takes long.
struct LeftOut {
  std::string name, takes;
};

struct BatchPlan {
  std::vector<BatchRun> runs;
  std::vector<LeftOut> left_out;
};

/// All scenes (files, names, or folders of them) with all combinations of the values, the last sweep fastest.
/// What takes long is left out of folders, unless `with` names it.
BatchPlan plan_batch(const std::vector<std::string>& scenes, const std::vector<Sweep>& sweeps,
                     const std::vector<std::string>& with, scene::Problems& problems);

}  // namespace shatterbox::sandbox::run
