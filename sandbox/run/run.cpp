#include "sandbox/run/run.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "engine/core/clock.h"
#include "engine/core/parallel.h"
#include "sandbox/report/json_report.h"
#include "sandbox/report/obj_frames.h"
#include "sandbox/report/summary.h"
#include "sandbox/run/interrupt.h"
#include "sandbox/run/painter.h"
#include "sandbox/run/progress.h"
#include "sandbox/run/projector.h"
#include "sandbox/run/recorder.h"
#include "sandbox/scene/build_world.h"
#include "sandbox/scene/find_scene.h"
#include "sandbox/study/study.h"

namespace shatterbox::sandbox::run {

namespace {

using core::Clock;
using core::milliseconds_since;

int refuse(const scene::Problems& problems) {
  fmt::print(stderr, "{}\n", scene::describe(problems));
  return kBadInput;
}

/// What a run works on.
struct Job {
  Options options;  // with a video if there is no other output
  PainterSettings painter;
  std::optional<scene::SceneDescription> scene;
  std::optional<scene::BuiltScene> built;
};

void check_stills(const Options& options, double seconds, scene::Problems& problems) {
  for (const double time : options.stills)
    if (!(time >= 0.0 && time < seconds))
      scene::book(problems, scene::Place{"--stills", 0, 0},
                  fmt::format("{:g} s is not in the film, which goes from 0 to {:g} s", time, seconds),
                  "--seconds makes it longer");
}

/// Which frames are drawn: all, or those that show the moments asked for.
class Choice {
 public:
  explicit Choice(std::vector<double> stills) : stills_(std::move(stills)), has_all_(stills_.empty()) {}
  /// `ahead`: the time of the next frame, s.
  bool takes(double ahead) {
    return std::erase_if(stills_, [ahead](double time) { return time < ahead - 1e-9; }) > 0 || has_all_;
  }

 private:
  std::vector<double> stills_;  // s, not drawn yet
  bool has_all_;
};

/// Reads everything; what is wrong goes to `problems`.
Job make_job(const Options& options, Recorder& recorder, scene::Problems& problems) {
  Job job{options, {}, std::nullopt, std::nullopt};
  const std::string file = scene::find_scene(options.scene, problems);
  const bool has_other_output = !options.frames_folder.empty() || !options.meshes_folder.empty();
  if (options.has_pictures && options.video.empty() && !has_other_output) {
    job.options.video = std::filesystem::path(options.scene).stem().string() + ".mp4";
  }
  if (const auto size = parse_size(options.size, problems)) job.painter.size = *size;
  job.painter.quality = options.quality == "full" ? render::Quality::full : render::Quality::preview;
  job.painter.frames_per_second = options.frames_per_second;
  job.painter.video = job.options.video;
  job.painter.frames_folder = options.frames_folder;
  if (!options.has_pictures && (!options.video.empty() || !options.frames_folder.empty())) {
    scene::book(problems, scene::Place{"--no-render", 0, 0}, "no pictures, but -o or --frames asks for some",
                "leave one of them out");
  }
  if (!options.stills.empty() && options.frames_folder.empty()) {
    scene::book(problems, scene::Place{"--stills", 0, 0}, "there is no folder for the pictures",
                "name one: --frames DIR");
  }
  if (!options.stills.empty() && !options.video.empty()) {
    scene::book(problems, scene::Place{"--stills", 0, 0}, "single moments make no video", "leave -o out");
  }
  if (file.empty()) return job;
  job.scene = scene::read_scene_file(file, changes_of(options), problems);
  if (job.scene) check_stills(options, job.scene->seconds, problems);
  prepare_outputs(job.options, problems);
  if (!problems.empty()) return job;
  const auto start = Clock::now();
  job.built = scene::build_world(*job.scene, problems);
  recorder.record.load.emplace_back("meshes", milliseconds_since(start));
  if (!job.built) return job;
  const auto prepared = Clock::now();
  job.built->world.prepare();
  recorder.record.load.emplace_back("factors", milliseconds_since(prepared));
  return job;
}

void describe_job(const Job& job, report::RunRecord& record) {
  const scene::SceneDescription& scene = *job.scene;
  record.version = SHATTERBOX_VERSION;
  record.compiler = SHATTERBOX_COMPILER;
  record.scene = scene.name;
  record.goal = scene.goal;
  record.seed = scene.world.seed;
  record.threads = core::thread_count();
  record.steps_per_second = scene.world.steps_per_second;
  record.frames_per_second = job.options.frames_per_second;
  record.asked_seconds = scene.seconds;
  record.warnings = scene.warnings;
  record.warnings.insert(record.warnings.end(), job.built->plan.notes.begin(), job.built->plan.notes.end());
  bool has_breakable = false, has_grains = false, has_script = !scene.events.empty();
  for (const scene::BodyEntry& body : scene.bodies) {
    has_script |= body.repeat.every > 0.0;
    const auto* shell = std::get_if<scene::ShellForm>(&body.form);
    if (shell == nullptr || !shell->is_breakable) continue;
    has_breakable = true;
    has_grains |= scene.materials[static_cast<std::size_t>(body.material)].material.grain_size > 0.0;
  }
  const auto sort_in = [&record](bool is_used, const char* name) {
    (is_used ? record.used : record.left_out).emplace_back(name);
  };
  sort_in(has_breakable, "shell_stress");
  sort_in(has_breakable, "fracture");
  sort_in(has_grains, "grains");
  sort_in(job.options.has_pictures, "render");
  sort_in(job.options.has_pictures && scene.light.casts_shadow, "shadow");
  sort_in(!job.options.video.empty(), "video");
  sort_in(has_script, "script");
}

/// The loop. A sentence if it failed, else empty.
std::string play(Job& job, Recorder& recorder, Painter* painter) {
  const scene::SceneDescription& scene = *job.scene;
  const world::World& world = job.built->world;
  const int fps = job.options.frames_per_second;
  Projector projector(scene, *job.built, recorder, job.options.has_audit, fps);
  view::View view(scene, *job.built);
  Choice choice(job.options.stills);
  Progress progress(std::max(1, static_cast<int>(scene.seconds * fps + 0.5)), stderr_is_terminal());
  std::vector<int> shown;  // how far the film is with each frame, in frames' lengths of the world's time
  for (int frame = 0;; ++frame) {
    const auto start = Clock::now();
    const double audited = recorder.record.audit_time;
    const std::optional<view::Moment> moment = projector.next();
    if (!moment) break;
    for (const scene::Cue& cue : projector.take_cues()) view.begin(cue, *moment);
    std::optional<render::Frame> picture;
    if (painter != nullptr && choice.takes(projector.time_ahead())) picture = view.make_frame(*moment);
    const double audit_time = recorder.record.audit_time - audited;
    recorder.note_frame(world, milliseconds_since(start) - audit_time, audit_time);
    if (!job.options.meshes_folder.empty()) {
      std::string fault =
          report::write_obj_frame(job.options.meshes_folder, frame, moment->bodies, moment->time);
      if (!fault.empty()) return fault;
    }
    if (picture && !painter->add(std::move(*picture), frame)) return painter->error();
    shown.push_back(static_cast<int>(projector.time_ahead() * fps + 1e-6));
    const bool is_whole_film = painter != nullptr && job.options.stills.empty();
    const int finished = is_whole_film ? painter->finished_frames() : frame + 1;
    progress.show(finished > 0 ? shown[static_cast<std::size_t>(finished) - 1] : 0,
                  fmt::format("{:.2f} s, {} bodies", world.time(), world.bodies().size()));
  }
  projector.finish();
  return {};
}

/// Closes the outputs and says what was done.
int finish(const Job& job, Recorder& recorder, Painter* painter, std::string fault, double wall_seconds) {
  report::RunRecord& record = recorder.record;
  if (painter != nullptr) {
    if (!painter->finish() && fault.empty()) fault = painter->error();
    recorder.note_pictures(painter->painted());
  }
  record.is_interrupted = is_interrupted();
  recorder.finish(job.built->world, wall_seconds);
  if (fault.empty() && !job.options.video.empty()) record.outputs.push_back(job.options.video);
  if (!job.options.frames_folder.empty()) record.outputs.push_back(job.options.frames_folder);
  if (!job.options.meshes_folder.empty()) record.outputs.push_back(job.options.meshes_folder);
  if (!job.options.report.empty()) {
    const std::string report_fault = report::write_report(job.options.report, record);
    if (report_fault.empty()) record.outputs.push_back(job.options.report);
    if (fault.empty()) fault = report_fault;
  }
  for (const std::string& warning : record.warnings) fmt::print(stderr, "warning: {}\n", warning);
  fmt::print("{}", report::make_summary(record));
  std::fflush(stdout);
  if (!fault.empty()) {
    fmt::print(stderr, "failed: {}\n", fault);
    return kFailed;
  }
  if (record.is_interrupted) return kFailed;
  return record.audit.crossings + record.audit.passages > 0 ? kDiffers : kDone;
}

}  // namespace

int run_scene(const Options& options) {
  if (options.scene.empty()) {
    fmt::print(stderr, "run needs a SCENE: a file, or one of\n");
    for (const scene::KnownScene& known : scene::known_scenes()) {
      fmt::print(stderr, "    {:<12} {}\n", known.name, known.goal);
    }
    fmt::print(stderr, "for example: shatterbox run ornament -o ornament.mp4\n");
    return kBadInput;
  }
  catch_interrupts();
  core::set_thread_count(options.threads);
  const auto start = Clock::now();
  Recorder recorder;
  scene::Problems problems;
  Job job = make_job(options, recorder, problems);
  if (!problems.empty()) return refuse(problems);
  describe_job(job, recorder.record);
  std::optional<Painter> painter;
  if (options.has_pictures && !(job.painter.video.empty() && job.painter.frames_folder.empty())) {
    painter.emplace(job.painter);
    if (!painter->error().empty()) {
      scene::book(problems, scene::Place{"-o", 0, 0}, painter->error());
      return refuse(problems);
    }
  }
  Painter* const hand = painter ? &*painter : nullptr;
  std::string fault;
  try {
    fault = play(job, recorder, hand);
  } catch (const std::exception& error) {
    fault = error.what();
  }
  if (hand != nullptr && !hand->finish() && fault.empty()) fault = hand->error();
  return finish(job, recorder, hand, std::move(fault), milliseconds_since(start) / 1000.0);
}

int check_scene(const Options& options) {
  scene::Problems problems;
  Recorder recorder;
  const std::string file = scene::find_scene(options.scene, problems);
  if (file.empty()) return refuse(problems);
  const auto scene = scene::read_scene_file(file, changes_of(options), problems);
  if (!scene) return refuse(problems);
  const auto built = scene::build_world(*scene, problems);
  if (!built) return refuse(problems);
  for (const std::string& note : built->plan.notes) fmt::print("note: {}\n", note);
  for (const std::string& warning : scene->warnings) fmt::print("warning: {}\n", warning);
  std::size_t triangles = 0;
  for (const body::Body& body : built->world.bodies()) triangles += body.shape->surface.triangles.size();
  fmt::print("{}: fine. {} bodies, {} triangles, {} events, {:g} s at {} steps a second\n", file,
             built->world.bodies().size(), triangles, scene->events.size(), scene->seconds,
             scene->world.steps_per_second);
  return kDone;
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
  row("backdrops", scene::kBackdropNames);
  row("overlays", scene::kOverlayNames);
  row("events", scene::kEventVerbs);
  fmt::print("studies\n");
  for (const study::Study& study : study::studies()) fmt::print("    {:<12} {}\n", study.name, study.what);
  return kDone;
}

}  // namespace shatterbox::sandbox::run
