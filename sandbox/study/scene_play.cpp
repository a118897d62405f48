#include "sandbox/study/scene_play.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sandbox/study/stopwatch.h"

namespace shatterbox::sandbox::study {

scene::SceneDescription scene_of(const std::string& text, const Overrides& overrides) {
  scene::Problems problems;
  scene::SceneChanges changes;
  changes.overrides = overrides;
  auto description = scene::read_scene(text, "study", changes, problems);
  if (!description) throw std::runtime_error(scene::describe(problems));
  return std::move(*description);
}

ScenePlay::ScenePlay(scene::SceneDescription description)
    : scene_(std::make_unique<scene::SceneDescription>(std::move(description))) {
  scene::Problems problems;
  auto built = scene::build_world(*scene_, problems);
  if (!built) throw std::runtime_error(scene::describe(problems));
  built_ = std::make_unique<scene::BuiltScene>(std::move(*built));
  built_->world.prepare();
  script_ = std::make_unique<script::Script>(*scene_);
}

void ScenePlay::step() {
  script_->play(*built_);
  const Stopwatch watch;
  built_->world.step();
  seconds_ += watch.seconds();
}

void ScenePlay::play_until(double time) {
  const long last = std::lround(time * scene_->world.steps_per_second);
  while (built_->world.steps() < last) step();
}

double distribution_distance(std::vector<double> a, std::vector<double> b) {
  if (a.empty() || b.empty()) return a.empty() && b.empty() ? 0.0 : 1.0;
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  double most = 0.0;
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    const double x = std::min(a[i], b[j]);
    while (i < a.size() && a[i] <= x) ++i;
    while (j < b.size() && b[j] <= x) ++j;
    const double share_a = static_cast<double>(i) / static_cast<double>(a.size());
    const double share_b = static_cast<double>(j) / static_cast<double>(b.size());
    most = std::max(most, std::abs(share_a - share_b));
  }
  return most;
}

}  // namespace shatterbox::sandbox::study
