#include "sandbox/run/run.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <vector>

#include <fmt/format.h>

#include "engine/core/clock.h"
#include "engine/core/parallel.h"
#include "sandbox/report/json_report.h"
#include "sandbox/report/summary.h"
#include "sandbox/run/checkpoint.h"
#include "sandbox/run/exports.h"
#include "sandbox/run/interrupt.h"
#include "sandbox/run/job.h"
#include "sandbox/run/plan.h"
#include "sandbox/run/progress.h"
#include "sandbox/run/screen.h"
#include "sandbox/run/showing.h"
#include "sandbox/run/side_by_side.h"
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

/// What all shots of a film share.
struct Film {
  Screen screen;  // nobody: no pictures
  Checkpoint checkpoint;
  int first_drawn = 0;  // frames below it are kept from an earlier run
};

/// The loop. A sentence if it failed, else empty. `first`: number of the first frame in the film.
std::string play(Job& job, Recorder& recorder, Film& film, int first, int shot) {
  const Screen& screen = film.screen;
  Painter* const painter = screen.painter;
  Showing showing(job, recorder, shot);
  Exports exports(job, showing.view(), film.first_drawn);
  Progress progress(showing.expected(), stderr_is_terminal());
  std::vector<int> shown;  // how far the film is with each frame
  for (int frame = 0; showing.advance(); ++frame) {
    const bool is_kept = first + frame < film.first_drawn;
    const bool is_drawn = painter != nullptr && showing.is_due() && !is_kept;
    if (!screen.takes(is_drawn) && is_kept) showing.pass_over();
    if (std::string fault = exports.add(showing.moment(), first + frame); !fault.empty()) return fault;
    if (std::string fault = film.checkpoint.pass(shot, showing.world(), painter); !fault.empty())
      return fault;
    recording::Panels panels;
    panels.push_back(showing.expose(screen.takes(is_drawn)));
    if (std::string fault = screen.add(std::move(panels), first + frame, is_drawn); !fault.empty())
      return fault;
    shown.push_back(showing.shown());
    const bool is_whole_film = painter != nullptr && job.options.stills.empty();
    const int finished = is_whole_film ? painter->finished_frames() - first : frame + 1;
    progress.show(reached(shown, finished), fmt::format("{:.2f} s, {} bodies", showing.world().time(),
                                                        showing.world().bodies().size()));
  }
  showing.finish();
  return exports.close();
}

/// After a shot: what its record says in the end.
void close_shot(Shot& shot, Clock::time_point start) {
  shot.recorder.record.is_interrupted = is_interrupted();
  shot.recorder.finish(shot.job->built->world, milliseconds_since(start) / 1000.0);
  sort_parts(plan_parts(*shot.job->scene, shot.job->options), shot.recorder.record);
}

void play_shot(Shot& shot, int number, Film& film, int first, std::string& fault) {
  const auto start = Clock::now();
  shot.first = first;
  try {
    fault = play(*shot.job, shot.recorder, film, first, number);
  } catch (const std::exception& error) {
    fault = error.what();
  }
  close_shot(shot, start);
}

/// One shot after the other. The first is played even if the run is interrupted already: its record says so.
void play_in_turn(std::vector<Shot>& shots, Film& film, std::string& fault) {
  int first = 0;
  for (std::size_t i = 0; i < shots.size() && fault.empty(); ++i) {
    if (i > 0 && is_interrupted()) return;
    if (shots.size() > 1)
      fmt::print(stderr, "shot {} of {}: {}\n", i + 1, shots.size(), shots[i].job->scene->name);
    play_shot(shots[i], static_cast<int>(i), film, first, fault);
    first += static_cast<int>(shots[i].recorder.record.frames.size());
  }
}

/// All shots at once, beside each other.
void play_compared(std::vector<Shot>& shots, const Screen& screen, std::string& fault) {
  const auto start = Clock::now();
  std::vector<Job*> jobs;
  std::vector<Recorder*> recorders;
  for (Shot& shot : shots) {
    jobs.push_back(&*shot.job);
    recorders.push_back(&shot.recorder);
  }
  try {
    fault = play_side_by_side(jobs, recorders, screen);
  } catch (const std::exception& error) {
    fault = error.what();
  }
  for (Shot& shot : shots) close_shot(shot, start);
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
  // Who does not listen any more is no fault of the run; a full disk is.
  if (std::fflush(stdout) != 0 && errno != EPIPE && fault.empty())
    fault = fmt::format("the closing words cannot be written: {}", std::strerror(errno));
  if (!fault.empty()) {
    fmt::print(stderr, "failed: {}\n", fault);
    return kFailed;
  }
  if (is_interrupted()) return kFailed;
  return breaches > 0 ? kDiffers : kDone;
}

/// Of all shots, which are one film.
recording::Settings recording_settings(const std::vector<Shot>& shots) {
  const PainterSettings& painter = shots.front().job->painter;
  recording::Settings settings;
  settings.program = SHATTERBOX_VERSION;
  for (const Shot& shot : shots)
    settings.scene += (settings.scene.empty() ? "" : ", ") + shot.job->scene->name;
  settings.goal = shots.front().job->scene->goal;
  settings.frames_per_second = static_cast<std::uint32_t>(painter.frames_per_second);
  settings.width = static_cast<std::uint32_t>(painter.size.width);
  settings.height = static_cast<std::uint32_t>(painter.size.height);
  settings.quality = painter.quality;
  settings.panels = static_cast<std::uint32_t>(painter.panels);
  return settings;
}

/// Plays the shots into one film: one after the other, or all beside each other.
int play_all(std::vector<Shot>& shots) {
  const Options options = shots.front().job->options;
  PainterSettings settings = shots.front().job->painter;
  scene::Problems problems;
  Outputs outputs;  // until the report is written
  add_outputs(options, outputs);
  outputs.take(problems);
  if (!problems.empty()) return refuse(problems);
  std::vector<const Job*> jobs;
  for (const Shot& shot : shots) jobs.push_back(&*shot.job);
  Film film{{}, Checkpoint(jobs)};
  if (options.resumes) film.checkpoint.load(problems);
  if (!problems.empty()) return refuse(problems);
  if (!options.resumes) film.checkpoint.discard();
  settings.kept = film.checkpoint.kept();
  if (!settings.kept.empty()) film.first_drawn = settings.kept.back().number + 1;
  std::optional<Painter> painter;
  if (options.has_pictures && !(settings.video + settings.frames_folder + settings.truth_folder).empty()) {
    painter.emplace(settings);
    if (!painter->opening_fault().empty()) {
      scene::book(problems, scene::Place{"-o", 0, 0}, painter->opening_fault());
      return refuse(problems);
    }
  }
  std::optional<recording::RecordingWriter> recording;
  if (!options.recording.empty()) recording.emplace(options.recording, recording_settings(shots));
  film.screen = {painter ? &*painter : nullptr, recording ? &*recording : nullptr};
  std::string fault;
  if (options.compare.empty())
    play_in_turn(shots, film, fault);
  else
    play_compared(shots, film.screen, fault);
  if (painter) {
    if (!painter->finish() && fault.empty()) fault = painter->error();
    for (Shot& shot : shots) shot.recorder.note_pictures(painter->painted(), shot.first);
  }
  if (recording && fault.empty()) fault = recording->close();
  if (fault.empty() && is_interrupted()) fault = film.checkpoint.save(film.screen.painter);
  if (fault.empty() && !is_interrupted()) film.checkpoint.discard();
  const bool goes_on = fault.empty() && options.compare.empty() && !film.checkpoint.file().empty();
  for (Shot& shot : shots) shot.recorder.record.goes_on = goes_on;
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
  heed_interrupts();
  core::set_thread_count(options.threads);
  scene::Problems problems;
  const std::vector<std::string> files = scene::shots_or_scene(options.scene);
  const std::string one_world = options.model + options.tables_folder + options.truth_folder;
  if (files.size() > 1 && !one_world.empty())
    scene::book(problems, scene::Place{"--export, --tables, --truth", 0, 0},
                fmt::format("{} is a film of {} shots, each a world of its own", options.scene, files.size()),
                fmt::format("take one of them: {}", files.front()));
  std::vector<std::string> settings;  // of each shot, where they are compared
  if (!options.compare.empty()) {
    settings = compared_settings(options.compare, problems);
    check_compare(options, problems);
    if (files.size() > 1)
      scene::book(problems, scene::Place{"--compare", 0, 0},
                  fmt::format("{} is a film of {} shots", options.scene, files.size()),
                  fmt::format("take one of them: {}", files.front()));
    if (!problems.empty()) return refuse(problems);
  }
  std::vector<Shot> shots(std::max(files.size(), settings.size()));
  for (std::size_t i = 0; i < shots.size(); ++i) {
    Options own = options;
    own.scene = settings.empty() ? files[i] : files.front();
    if (!settings.empty()) own.overrides.push_back(settings[i]);
    if (shots.size() > 1) own.video = film_of(options);
    shots[i].job = make_job(own, shots[i].recorder, problems);
    shots[i].job->painter.panels = std::max<int>(1, static_cast<int>(settings.size()));
    if (!settings.empty()) shots[i].recorder.record.scene += ", " + settings[i];
    if (!settings.empty() && !problems.empty()) break;  // the others have the same ones
  }
  if (!problems.empty()) return refuse(problems);
  catch_interrupts();
  return play_all(shots);
}

}  // namespace shatterbox::sandbox::run
