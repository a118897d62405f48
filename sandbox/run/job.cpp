#include "sandbox/run/job.h"

#include <cstdio>
#include <filesystem>

#include <fmt/format.h>

#include "engine/core/clock.h"
#include "engine/core/parallel.h"
#include "sandbox/run/doubts.h"
#include "sandbox/run/exports.h"
#include "sandbox/run/progress.h"
#include "sandbox/scene/find_scene.h"

namespace shatterbox::sandbox::run {

namespace {

using core::Clock;
using core::milliseconds_since;

void check_stills(const Options& options, double seconds, scene::Problems& problems) {
  for (const double time : options.stills)
    if (!(time >= 0.0 && time < seconds))
      scene::book(
          problems, scene::Place{"--stills", 0, 0},
          fmt::format("{:g} s is not in the film, whose pictures are all before {:g} s", time, seconds),
          "--seconds makes it longer");
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
  if (!job.options.report.empty())
    for (const scene::BodyTetrahedra& own : scene::find_tetrahedra(*job.built))
      record.tetrahedra.emplace_back(scene.bodies[static_cast<std::size_t>(own.entry)].name, own.quality);
  for (const scene::Problem& doubt : find_doubts(scene, *job.built))
    record.warnings.push_back(scene::describe(doubt));
}

}  // namespace

void add_scene(const std::string& who, const std::string& file,
               const std::optional<scene::SceneDescription>& scene, Outputs& outputs) {
  outputs.read_file(who, file);
  if (!scene) return;
  for (const scene::BodyEntry& body : scene->bodies) {
    const scene::MeshForm* form = scene::find_mesh_form(body.form);
    const auto* meshes = form == nullptr ? nullptr : std::get_if<scene::MeshFileShape>(&form->shape);
    if (meshes == nullptr) continue;
    for (const std::string& mesh : meshes->files)
      outputs.read_file(fmt::format("the body \"{}\" of {}", body.name, who), mesh);
  }
}

void add_outputs(const Options& options, Outputs& outputs) {
  outputs.write_file("-o", options.video);
  outputs.write_folder("--frames", options.frames_folder, {"frame_*.png"});
  outputs.write_folder("--meshes", options.meshes_folder, {"frame_*.obj"});
  outputs.write_file("--export", options.model);
  outputs.write_folder("--tables", options.tables_folder,
                       {"bodies.csv", "bodies.json", "trajectories.csv", "trajectories.json", "impacts.csv",
                        "impacts.json", "breaks.csv", "breaks.json"});
  outputs.write_folder("--truth", options.truth_folder, {"truth_*.npz", "bodies.csv", "bodies.json"});
  outputs.write_file("--record", options.recording);
  outputs.write_file("--report", options.report);
}

std::string film_of(const Options& options) {
  const bool has_other_output = !options.frames_folder.empty() || !export_outputs(options).empty();
  if (!options.has_pictures || !options.video.empty() || has_other_output) return options.video;
  const std::filesystem::path path =
      std::filesystem::path(options.scene) / "";  // a folder may end in a slash
  return path.parent_path().stem().string() + ".mp4";
}

int refuse(const scene::Problems& problems) {
  fmt::print(stderr, "{}\n", scene::describe(problems));
  return kBadInput;
}

Job make_job(const Options& options, Recorder& recorder, scene::Problems& problems) {
  Job job{options, {}, std::nullopt, std::nullopt};
  const std::string file = scene::find_scene(options.scene, problems);
  job.options.video = film_of(options);
  if (const auto size = parse_size(options.size, problems)) job.painter.size = *size;
  job.painter.quality = parse_quality(options.quality);
  job.painter.back_end = parse_back_end(options.gl, problems);
  job.painter.frames_per_second = options.frames_per_second;
  job.painter.video = job.options.video;
  job.painter.has_pass_times = !options.report.empty();
  job.painter.frames_folder = options.frames_folder;
  job.painter.truth_folder = options.truth_folder;
  const bool has_folder = !options.frames_folder.empty() || !options.truth_folder.empty();
  if (!options.has_pictures && (!options.video.empty() || has_folder)) {
    scene::book(problems, scene::Place{"--no-render", 0, 0},
                "no pictures, but -o, --frames or --truth asks for some", "leave one of them out");
  }
  if (!options.stills.empty() && !has_folder) {
    scene::book(problems, scene::Place{"--stills", 0, 0}, "there is no folder for the pictures",
                "name one: --frames DIR or --truth DIR");
  }
  if (!options.stills.empty() && !options.video.empty()) {
    scene::book(problems, scene::Place{"--stills", 0, 0}, "single moments make no video",
                "write no -o, or no --stills for the whole film");
  }
  if (file.empty()) return job;
  job.scene = scene::read_scene_file(file, changes_of(options), problems);
  if (job.scene) check_stills(options, job.scene->seconds, problems);
  check_video(job.options.video, problems);
  check_exports(job.options, problems);
  if (options.has_trace && options.report.empty())
    scene::book(problems, scene::Place{"--trace", 0, 0}, "is kept in the report, and none is asked for",
                "add --report FILE");
  Outputs outputs;
  add_outputs(job.options, outputs);
  add_scene("SCENE", file, job.scene, outputs);
  outputs.read_file("--script", options.script);
  outputs.check(problems);
  if (!problems.empty()) return job;
  const auto start = Clock::now();
  const int body_count = static_cast<int>(job.scene->bodies.size());
  Progress progress(body_count + 1, stderr_is_terminal());
  job.built = scene::build_world(*job.scene, problems,
                                 [&](int body, const std::string& note) { progress.show(body, note); });
  recorder.record.load.emplace_back("meshes", milliseconds_since(start));
  if (!job.built) return job;
  const auto prepared = Clock::now();
  progress.show(body_count, "what the stress needs");
  job.built->world.prepare();
  recorder.record.load.emplace_back("factors", milliseconds_since(prepared));
  describe_job(job, recorder.record);
  return job;
}

}  // namespace shatterbox::sandbox::run
