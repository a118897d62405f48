// A scene played for a study: built, its events on step borders, the processor time of its steps.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sandbox/scene/build_world.h"
#include "sandbox/scene/read_scene.h"
#include "sandbox/script/script.h"

namespace shatterbox::sandbox::study {

using Overrides = std::vector<std::string>;  // NAME.key=value

/// A scene from its text. Throws, with its problems, what a study's own text must not have.
scene::SceneDescription scene_of(const std::string& text, const Overrides& overrides);

class ScenePlay {
 public:
  /// Builds it, with the factors that would be made at load. Throws where it cannot be built.
  explicit ScenePlay(scene::SceneDescription description);

  void step();
  /// Steps until that time (s) of the scene.
  void play_until(double time);

  world::World& world() { return built_->world; }
  const scene::SceneDescription& scene() const { return *scene_; }
  double seconds() const { return seconds_; }  // processor time of the steps

 private:
  std::unique_ptr<scene::SceneDescription> scene_;  // the script holds on to it
  std::unique_ptr<scene::BuiltScene> built_;
  std::unique_ptr<script::Script> script_;
  double seconds_ = 0.0;
};

/// Greatest distance of the two cumulative distributions (Kolmogorov and Smirnov), from 0 to 1; 1 if one is
/// empty.
double distribution_distance(std::vector<double> a, std::vector<double> b);

}  // namespace shatterbox::sandbox::study
