// Reads a scene text in tests, and says what came out.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sandbox/scene/read_scene.h"

namespace shatterbox::sandbox::scene {

struct Reading {
  std::optional<SceneDescription> scene;
  Problems problems;
  std::string text;  // all problems, as a person sees them
};

inline Reading read(const std::string& text, const std::vector<std::string>& overrides = {},
                    const std::string& script = "") {
  Reading reading;
  reading.scene = read_scene(text, "t.toml", {overrides, script}, reading.problems);
  reading.text = describe(reading.problems);
  return reading;
}

}  // namespace shatterbox::sandbox::scene
