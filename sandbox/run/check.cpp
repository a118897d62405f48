#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "sandbox/run/doubts.h"
#include "sandbox/run/job.h"
#include "sandbox/run/run.h"
#include "sandbox/scene/find_scene.h"
#include "sandbox/scene/words.h"
#include "sandbox/study/study.h"

namespace shatterbox::sandbox::run {

namespace {

int check_one(const Options& options) {
  scene::Problems problems;
  const std::string file = scene::find_scene(options.scene, problems);
  if (file.empty()) return refuse(problems);
  const auto scene = scene::read_scene_file(file, changes_of(options), problems);
  if (!scene) return refuse(problems);
  const auto built = scene::build_world(*scene, problems);
  if (!built) return refuse(problems);
  for (const std::string& note : built->plan.notes) fmt::print("note: {}\n", note);
  std::vector<std::string> warnings = scene->warnings;
  for (const scene::Problem& doubt : find_doubts(*scene, *built)) warnings.push_back(scene::describe(doubt));
  for (const std::string& warning : warnings) fmt::print("warning: {}\n", warning);
  std::size_t triangles = 0;
  for (const body::Body& body : built->world.bodies()) triangles += body.shape->surface.triangles.size();
  const std::string verdict =
      warnings.empty() ? "fine" : scene::counted(static_cast<long>(warnings.size()), "warning") + "; it runs";
  fmt::print("{}: {}. {}, {}, {}, {:g} s at {} steps a second\n", file, verdict,
             scene::counted(static_cast<long>(built->world.bodies().size()), "body", "bodies"),
             scene::counted(static_cast<long>(triangles), "triangle"),
             scene::counted(static_cast<long>(scene->events.size()), "event"), scene->seconds,
             scene->world.steps_per_second);
  return kDone;
}

}  // namespace

int check_scene(const Options& options) {
  int status = kDone;
  for (const std::string& file : scene::shots_or_scene(options.scene)) {
    Options own = options;
    own.scene = file;
    status = std::max(status, check_one(own));
  }
  return status;
}

int list_all() {
  fmt::print("scenes\n");
  for (const scene::KnownScene& known : scene::known_scenes())
    fmt::print("    {:<12} {}\n", known.name, known.goal);
  fmt::print("materials\n");
  for (const material::Preset& preset : material::presets()) {
    const material::Material& m = preset.material;
    fmt::print("    {:<12} {:g} kg/m3, {:g} GPa, strength {:g} MPa; {}\n", m.name, m.density, 1e-9 * m.young,
               1e-6 * m.strength, preset.source);
  }
  const auto row = [](const char* title, const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
    fmt::print("{}\n    {}\n", title, text);
  };
  row("looks", scene::kLookNames);
  row("grounds", scene::kGroundNames);
  row("lights", scene::kLightNames);
  row("backdrops", scene::kBackdropNames);
  row("overlays", scene::kOverlayNames);
  row("events", scene::kEventVerbs);
  fmt::print("studies\n");
  for (const study::Study& study : study::studies()) fmt::print("    {:<12} {}\n", study.name, study.what);
  return kDone;
}

}  // namespace shatterbox::sandbox::run
