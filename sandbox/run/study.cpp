#include "sandbox/run/study.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <optional>

#include <fmt/format.h>

#include "engine/core/parallel.h"
#include "sandbox/report/text_file.h"
#include "sandbox/run/interrupt.h"
#include "sandbox/run/options.h"
#include "sandbox/run/outputs.h"
#include "sandbox/run/progress.h"
#include "sandbox/scene/build_world.h"
#include "sandbox/scene/find_scene.h"
#include "sandbox/scene/nearest_name.h"
#include "sandbox/scene/read_scene.h"
#include "sandbox/study/own_reference.h"
#include "sandbox/study/plot.h"
#include "sandbox/study/study.h"
#include "sandbox/study/telling.h"

namespace shatterbox::sandbox::run {

namespace {

/// A word that ends in .toml, or is a path, or names a scene and no study.
bool is_scene(const std::string& word) {
  if (word.size() > 5 && word.ends_with(".toml")) return true;
  if (word.find('/') != std::string::npos) return true;
  const auto known = scene::known_scenes();
  return std::any_of(known.begin(), known.end(), [&](const scene::KnownScene& s) { return s.name == word; });
}

/// The study of that name, or of that scene; nothing, after saying why.
std::optional<study::Study> find_study(const std::string& word) {
  std::vector<std::string> names;
  for (const study::Study& study : study::studies()) {
    if (study.name == word) return study;
    names.push_back(study.name);
  }
  if (!word.empty() && is_scene(word)) {
    scene::Problems problems;
    const std::string file = scene::find_scene(word, problems);
    if (!file.empty()) {
      const auto description = scene::read_scene_file(file, {}, problems);
      // What cannot be built is told now, and not after the first row.
      if (description && scene::build_world(*description, problems) && problems.empty())
        return study::scene_study(*description);
    }
    fmt::print(stderr, "{}\n", scene::describe(problems));
    return std::nullopt;
  }
  if (word.empty()) {
    fmt::print(stderr, "study needs a NAME, or a SCENE.toml to be compared with itself at a finer step\n");
  } else {
    fmt::print(stderr, "there is no study \"{}\"\n    {}\n", word,
               scene::hint_for_name(word, names, "studies"));
  }
  for (const study::Study& study : study::studies())
    fmt::print(stderr, "    {:<12} {}\n", study.name, study.what);
  return std::nullopt;
}

/// Writes what was found; a sentence if that fails.
std::string write_results(const study::StudyResult& result, const std::string& name, const std::string& what,
                          const std::filesystem::path& folder) {
  for (const auto& [ending, text] :
       {std::pair<const char*, std::string>{".csv", study::to_csv(result.tables)},
        {".txt", study::describe(result)},
        {".md", study::to_markdown(result, name, what)}}) {
    std::string fault = report::write_text((folder / (name + ending)).string(), text);
    if (!fault.empty()) return fault;
  }
  return {};
}

}  // namespace

int run_study(const StudyOptions& options) {
  const auto study = find_study(options.what);
  if (!study) return kBadInput;
  const std::string folder = options.folder.empty() ? "study_" + study->name : options.folder;
  scene::Problems problems;
  Outputs outputs;
  outputs.write_folder("-o", folder);
  outputs.check(problems);
  if (problems.empty()) outputs.take(problems);
  if (!problems.empty()) {
    fmt::print(stderr, "{}\n", scene::describe(problems));
    return kBadInput;
  }
  catch_interrupts();
  core::set_thread_count(1);  // processor time of one thread is what a setting costs
  const study::Plan plan = study->plan(options.is_quick);
  Progress progress(static_cast<int>(plan.jobs.size()), stderr_is_terminal());
  study::RunSettings settings;
  settings.is_quick = options.is_quick;
  settings.go_on = [&progress](int done, int, const std::string& note) {
    progress.show(done, note);
    return !is_interrupted();
  };
  const study::StudyResult result = study::run_plan(plan, settings);
  progress.clear();
  const std::string fault = write_results(result, study->name, study->what, folder);
  if (!fault.empty()) {
    fmt::print(stderr, "failed: {}\n", fault);
    return kFailed;
  }
  std::string plot_fault = study::draw_plot(result.tables, study->what, study->name, folder);
  for (const study::Figure& figure : result.figures)
    if (plot_fault.empty()) plot_fault = study::draw_figure(figure, study->name, folder);
  fmt::print("{}\n{}/{}.csv .txt .md{}\n", study::describe(result), folder, study->name,
             plot_fault.empty() ? " .png .svg" : "");
  if (!plot_fault.empty()) fmt::print(stderr, "{}\n", plot_fault);
  return result.is_whole ? kDone : kFailed;
}

}  // namespace shatterbox::sandbox::run
