#include "sandbox/run/run.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <vector>

#include <fmt/format.h>

#include "engine/core/clock.h"
#include "engine/core/parallel.h"
#include "sandbox/report/json_report.h"
#include "sandbox/report/summary.h"
#include "sandbox/run/checkpoint.h"
#include "sandbox/run/exports.h"
#include "sandbox/run/exposure.h"
#include "sandbox/run/interrupt.h"
#include "sandbox/run/job.h"
#include "sandbox/run/plan.h"
#include "sandbox/run/progress.h"
#include "sandbox/run/projector.h"
#include "sandbox/scene/find_scene.h"

namespace shatterbox::sandbox::run {

namespace {

using core::Clock;
using core::milliseconds_since;

/// One scene of a run: most runs have one.
struct Shot {
  Recorder recorder;
  std::optional<Job> job;
  int first = 0;  // number of its first frame in the film
};

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

/// What all shots of a film share.
struct Film {
  Painter* painter = nullptr;  // none: no pictures
  Checkpoint checkpoint;
  int first_drawn = 0;  // frames below it are kept from an earlier run
};

/// The pictures of one frame, of which `moment` is the first, if it is drawn; steps to its last moment.
std::vector<render::Frame> expose(const view::Moment& moment, const Exposure& exposure, bool is_drawn,
                                  Projector& projector, view::View& view) {
  std::vector<render::Frame> samples;
  std::optional<view::Moment> now = moment;
  const int samples_a_slot = exposure.slots() == 1 ? exposure.samples() : 1;
  for (int slot = 0; now && slot < exposure.slots(); ++slot) {
    if (slot > 0) {
      now = projector.next();
      if (!now) break;
      for (const scene::Cue& cue : projector.take_cues()) view.begin(cue, *now);
    }
    for (int i = 0; is_drawn && i < samples_a_slot && slot < exposure.samples(); ++i) {
      const auto number = static_cast<int>(samples.size());
      samples.push_back(view.make_frame(*now, exposure.lens_point(number)));
      samples.back().caption = samples.front().caption;  // numbers are not blurred
      samples.back().title = samples.front().title;
    }
  }
  return samples;
}

/// The loop. A sentence if it failed, else empty. `first`: number of the first frame in the film.
std::string play(Job& job, Recorder& recorder, Film& film, int first, int shot) {
  Painter* const painter = film.painter;
  const scene::SceneDescription& scene = *job.scene;
  const world::World& world = job.built->world;
  const int fps = job.options.frames_per_second;
  const Exposure exposure(scene.camera);
  Projector projector(scene, *job.built, recorder, job.options.has_audit, fps, exposure.slots());
  view::View view(scene, *job.built, shot);
  Exports exports(job, view, film.first_drawn);
  Choice choice(job.options.stills);
  Progress progress(std::max(1, static_cast<int>(scene.seconds * fps + 0.5)), stderr_is_terminal());
  std::vector<int> shown;  // how far the film is with each frame, in frames' lengths of the world's time
  for (int frame = 0;; ++frame) {
    const auto start = Clock::now();
    const double audited = recorder.record.audit_time;
    const std::optional<view::Moment> moment = projector.next();
    if (!moment) break;
    for (const scene::Cue& cue : projector.take_cues()) view.begin(cue, *moment);
    const bool is_due = choice.takes(projector.time_ahead()), is_kept = first + frame < film.first_drawn;
    const bool is_drawn = painter != nullptr && is_due && !is_kept;
    if (is_kept) (void)view.camera_at(*moment);  // it remembers whom it follows
    if (std::string fault = exports.add(*moment, first + frame); !fault.empty()) return fault;
    if (std::string fault = film.checkpoint.pass(shot, world, painter); !fault.empty()) return fault;
    std::vector<render::Frame> samples =
        expose(*moment, exposure, is_drawn, projector, view);  // steps on while the shutter is open
    const double audit_time = recorder.record.audit_time - audited;
    recorder.note_frame(world, milliseconds_since(start) - audit_time, audit_time);
    if (is_drawn && !painter->add(std::move(samples), first + frame)) return painter->error();
    shown.push_back(static_cast<int>(projector.time_ahead() * fps + 1e-6));
    const bool is_whole_film = painter != nullptr && job.options.stills.empty();
    const int finished = is_whole_film ? painter->finished_frames() - first : frame + 1;
    progress.show(finished > 0 ? shown[static_cast<std::size_t>(finished) - 1] : 0,
                  fmt::format("{:.2f} s, {} bodies", world.time(), world.bodies().size()));
  }
  projector.finish();
  return exports.close();
}

void play_shot(Shot& shot, int number, Film& film, int first, std::string& fault) {
  const auto start = Clock::now();
  shot.first = first;
  try {
    fault = play(*shot.job, shot.recorder, film, first, number);
  } catch (const std::exception& error) {
    fault = error.what();
  }
  shot.recorder.record.is_interrupted = is_interrupted();
  shot.recorder.finish(shot.job->built->world, milliseconds_since(start) / 1000.0);
  sort_parts(plan_parts(*shot.job->scene, shot.job->options), shot.recorder.record);
}

/// The reports and the closing words of all shots that were played. The exit status.
int conclude(std::vector<Shot>& shots, const Options& options, std::string fault) {
  std::vector<report::RunRecord*> records;
  for (Shot& shot : shots)
    if (shot.recorder.record.wall_seconds > 0.0) records.push_back(&shot.recorder.record);
  std::vector<std::string> outputs;
  if (fault.empty() && !options.video.empty()) outputs.push_back(options.video);
  if (!options.frames_folder.empty()) outputs.push_back(options.frames_folder);
  for (std::string& output : export_outputs(options)) outputs.push_back(std::move(output));
  if (!options.report.empty()) {
    const std::string report_fault = report::write_report(options.report, {records.begin(), records.end()});
    if (report_fault.empty()) outputs.push_back(options.report);
    if (fault.empty()) fault = report_fault;
  }
  if (!records.empty()) records.back()->outputs = outputs;
  long breaches = 0;
  for (const report::RunRecord* record : records) {
    for (const std::string& warning : record->warnings) fmt::print(stderr, "warning: {}\n", warning);
    fmt::print("{}", report::make_summary(*record));
    breaches += record->audit.crossings + record->audit.passages;
  }
  std::fflush(stdout);
  if (!fault.empty()) {
    fmt::print(stderr, "failed: {}\n", fault);
    return kFailed;
  }
  if (is_interrupted()) return kFailed;
  return breaches > 0 ? kDiffers : kDone;
}

/// Plays the shots one after the other into one film.
int play_all(std::vector<Shot>& shots) {
  const Options options = shots.front().job->options;
  PainterSettings settings = shots.front().job->painter;
  scene::Problems problems;
  std::vector<const Job*> jobs;
  for (const Shot& shot : shots) jobs.push_back(&*shot.job);
  Film film{nullptr, Checkpoint(jobs)};
  if (options.resumes) film.checkpoint.load(problems);
  if (!problems.empty()) return refuse(problems);
  if (!options.resumes) film.checkpoint.discard();
  settings.kept = film.checkpoint.kept();
  if (!settings.kept.empty()) film.first_drawn = settings.kept.back().number + 1;
  std::optional<Painter> painter;
  if (options.has_pictures && !(settings.video + settings.frames_folder + settings.truth_folder).empty()) {
    painter.emplace(settings);
    if (!painter->error().empty()) {
      scene::book(problems, scene::Place{"-o", 0, 0}, painter->error());
      return refuse(problems);
    }
  }
  film.painter = painter ? &*painter : nullptr;
  std::string fault;
  int first = 0;
  for (std::size_t i = 0; i < shots.size() && fault.empty() && !is_interrupted(); ++i) {
    if (shots.size() > 1)
      fmt::print(stderr, "shot {} of {}: {}\n", i + 1, shots.size(), shots[i].job->scene->name);
    play_shot(shots[i], static_cast<int>(i), film, first, fault);
    first += static_cast<int>(shots[i].recorder.record.frames.size());
  }
  if (painter) {
    if (!painter->finish() && fault.empty()) fault = painter->error();
    for (Shot& shot : shots) shot.recorder.note_pictures(painter->painted(), shot.first);
  }
  if (fault.empty() && is_interrupted()) fault = film.checkpoint.save(film.painter);
  if (fault.empty() && !is_interrupted()) film.checkpoint.discard();
  return conclude(shots, options, std::move(fault));
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
  scene::Problems problems;
  const std::vector<std::string> files = scene::shots_or_scene(options.scene);
  const std::string one_world = options.model + options.tables_folder + options.truth_folder;
  if (files.size() > 1 && !one_world.empty())
    scene::book(problems, scene::Place{"--export, --tables, --truth", 0, 0},
                fmt::format("{} is a film of {} shots, each a world of its own", options.scene, files.size()),
                fmt::format("take one of them: {}", files.front()));
  std::vector<Shot> shots(files.size());
  for (std::size_t i = 0; i < files.size(); ++i) {
    Options own = options;
    own.scene = files[i];
    if (files.size() > 1) own.video = film_of(options);
    shots[i].job = make_job(own, shots[i].recorder, problems);
  }
  if (!problems.empty()) return refuse(problems);
  return play_all(shots);
}

}  // namespace shatterbox::sandbox::run
