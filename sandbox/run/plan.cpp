#include "sandbox/run/plan.h"

#include <sys/resource.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "engine/core/clock.h"
#include "engine/core/elementary.h"
#include "engine/core/parallel.h"
#include "engine/world/forms.h"
#include "sandbox/run/exposure.h"
#include "sandbox/run/foresee.h"
#include "sandbox/run/job.h"
#include "sandbox/run/projector.h"
#include "sandbox/scene/find_scene.h"

namespace shatterbox::sandbox::run {

namespace {

using core::Clock;
using core::milliseconds_since;

constexpr int kFirstSteps = 12;
constexpr std::size_t kMostTrials = 6;

/// What the first steps and the first picture took, ms.
struct Measured {
  double load = 0.0, factors = 0.0;
  double step = 0.0;
  double picture = 0.0, shadow = 0.0;
  double memory = 0.0;  // MB
};

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0.0 : values[values.size() / 2];
}

void measure_picture(const Job& job, const render::Frame& frame, Measured& measured) {
  render::Renderer renderer(job.painter.size, job.painter.quality, job.painter.back_end);
  (void)renderer.render(frame);  // compiles the shaders
  renderer.set_timing(true);
  renderer.forget();
  const auto start = Clock::now();
  (void)renderer.render(frame);
  measured.picture = milliseconds_since(start);
  for (const auto& pass : renderer.pass_times().passes)
    if (pass.name == "shadow") measured.shadow = pass.wall_ms;
}

Measured measure(Job& job, Recorder& recorder) {
  Measured measured;
  for (const auto& [name, milliseconds] : recorder.record.load) {
    measured.load += milliseconds;
    if (name == "factors") measured.factors = milliseconds;
  }
  if (job.options.has_pictures) {
    view::View view(*job.scene, *job.built);
    measure_picture(job, view.make_frame(), measured);
  }
  std::vector<double> steps;
  script::Script script(*job.scene);
  for (int i = 0; i < kFirstSteps; ++i) {
    const auto start = Clock::now();
    (void)script.play(*job.built);
    job.built->world.step();
    steps.push_back(milliseconds_since(start));
  }
  measured.step = median(steps);
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  measured.memory = static_cast<double>(usage.ru_maxrss) / 1024.0;
  return measured;
}

void tell_parts(const std::vector<PartPlan>& parts, bool is_needed, const char* title) {
  fmt::print("{}\n", title);
  for (const PartPlan& plan : parts)
    if (plan.is_needed == is_needed) fmt::print("    {:<17} {}\n", plan.name, plan.why);
}

void tell_inventory(const std::vector<world::PartCount>& rows) {
  fmt::print("made of them when loaded\n");
  for (const world::PartCount& row : rows)
    fmt::print("    {:<17} {:>6} {:>10.2f} MB\n", row.part, row.count, row.bytes / 1e6);
}

void tell_tetrahedra(const scene::SceneDescription& scene, const scene::BuiltScene& built) {
  const auto degrees = [](double angle) { return angle * 180.0 / core::kPi; };
  const std::vector<scene::BodyTetrahedra> all = scene::find_tetrahedra(built);
  if (!all.empty()) fmt::print("tetrahedra of what can break\n");
  for (const auto& [entry, quality] : all)
    fmt::print(
        "    {:<17} {:>6} of {:.2g} m; dihedral angles {:.0f} to {:.0f} degrees, half have none below "
        "{:.0f}; aspect {:.2g}, at worst {:.2g}\n",
        scene.bodies[static_cast<std::size_t>(entry)].name, quality.count, quality.mean_edge_length,
        degrees(quality.least_dihedral), degrees(quality.greatest_dihedral),
        degrees(quality.median_least_dihedral), quality.median_aspect, quality.worst_aspect);
}

void tell_foreseen(const std::vector<Foreseen>& all, const scene::SceneDescription& scene) {
  const auto breakable = std::count_if(scene.bodies.begin(), scene.bodies.end(), scene::can_break);
  if (breakable == 0) return;
  const bool has_trials_of_one = std::any_of(all.begin(), all.end(), [](const Foreseen& foreseen) {
    return foreseen.has_others || foreseen.is_alone;
  });
  fmt::print("foreseen, by stepping the scene to the first break{}\n",
             has_trials_of_one ? "; of each body as if nothing else could break" : "");
  for (const Foreseen& foreseen : all) fmt::print("    {}\n", describe(foreseen));
  if (const auto others = breakable - static_cast<std::ptrdiff_t>(all.size()); others > 0)
    fmt::print("    {} more that can break were not tried\n", others);
}

/// What breaks as foreseen costs, ms of the simulation: copies that were tried together are in one trial.
double cost_of_breaks(const std::vector<Foreseen>& all) {
  double cost = 0.0;
  for (const Foreseen& foreseen : all) cost += (foreseen.is_alone ? foreseen.copies : 1) * foreseen.all_ms;
  return cost;
}

void tell_expectation(const Job& job, const Measured& measured, const std::vector<Foreseen>& foreseen) {
  const int fps = job.options.frames_per_second;
  const double steps_a_frame = static_cast<double>(job.scene->world.steps_per_second) / fps;
  const double frames = std::max(1.0, job.scene->seconds * fps);
  fmt::print("expected\n");
  fmt::print("    memory            {:.0f} MB so far\n", measured.memory);
  fmt::print("    loading           {:.2f} s, {:.2f} s of it factors\n", 1e-3 * measured.load,
             1e-3 * measured.factors);
  fmt::print("    a step            {:.3f} ms, as the first {} took\n", measured.step, kFirstSteps);
  const double simulate = steps_a_frame * measured.step;
  if (job.options.has_pictures)
    fmt::print("    a picture         {:.1f} ms, drawn wholly; what does not change is kept\n",
               measured.picture);
  const int samples = Exposure(job.scene->camera).samples();
  if (job.options.has_pictures && samples > 1) fmt::print("    a frame           {} pictures\n", samples);
  // Steps and pictures have a thread each.
  const double a_frame = std::max(simulate, samples * measured.picture);
  const double all = 1e-3 * (measured.load + frames * a_frame);
  const auto given_up =
      std::find_if(foreseen.begin(), foreseen.end(), [](const Foreseen& f) { return f.was_given_up; });
  if (given_up == foreseen.end())
    fmt::print("    in all            {:.0f} frames at true speed: {:.1f} s, if it goes on as it begins\n",
               frames, all);
  else
    fmt::print(
        "    in all            {:.0f} frames at true speed: {:.1f} s until \"{}\" is hit hard, and minutes "
        "from then on\n",
        frames, std::min(all, 1e-3 * (measured.load + given_up->given_up_at * fps * a_frame)),
        given_up->body);
  if (const double breaks = cost_of_breaks(foreseen); breaks > 0.0)
    fmt::print(
        "    breaks            {:.1f} s more for the first {:g} s of those foreseen, each copy as the one "
        "tried; what breaks later, by others or among pieces, comes on top\n",
        1e-3 * breaks, kAftermath);
}

/// The solid that can break of which there are most, and its elements' size, m; none: null.
std::pair<const scene::BodyEntry*, double> finest_solid(const Job& job) {
  std::map<int, int> copies;
  for (const auto& [id, origin] : job.built->origins) ++copies[origin.entry];
  const scene::BodyEntry* most = nullptr;
  double size = 0.0;
  int count = 0;
  for (const auto& [entry, number] : copies) {
    const auto i = static_cast<std::size_t>(entry);
    const auto* solid = std::get_if<world::SolidDescription>(&job.built->plan.bodies[i].description.form);
    if (solid == nullptr || !solid->is_breakable || number <= count) continue;
    most = &job.scene->bodies[i];
    size = world::element_size_of(*solid);
    count = number;
  }
  return {most, size};
}

void tell_lean(const Job& job, const Measured& measured, const std::vector<PartPlan>& parts) {
  const auto needs = [&parts](const char* name) {
    return std::any_of(parts.begin(), parts.end(),
                       [name](const PartPlan& plan) { return plan.name == name && plan.is_needed; });
  };
  fmt::print("what could still be switched off\n");
  const auto row = [](const std::string& how, const std::string& saves) {
    fmt::print("    {:<46} {}\n", how, saves);
  };
  double factor_bytes = 0.0;
  for (const world::PartCount& part : job.built->world.inventory())
    if (part.part == "factors" || part.part == "shell_stiffness") factor_bytes += part.bytes;
  if (needs("shell_stress"))
    row("breakable = false, where nothing need break",
        fmt::format("at most {:.2f} s of loading, {:.1f} MB, and all that breaking costs",
                    1e-3 * measured.factors, factor_bytes / 1e6));
  if (const auto [solid, size] = finest_solid(job); solid != nullptr)
    row(fmt::format("--set {}.element_size={:.2g}", solid->name, 2.0 * size),
        "an eighth of its tetrahedra: cheaper breaks, told more coarsely");
  if (needs("shadow"))
    row("--set light.shadow=false",
        fmt::format("{:.1f} of {:.1f} ms a picture", measured.shadow, measured.picture));
  if (job.options.has_pictures && job.options.quality == "full")
    row("--quality preview", "about half of each picture");
  if (job.options.has_pictures && job.options.frames_per_second > 30)
    row("--fps 30", fmt::format("{:.0f} pictures", 0.5 * job.options.frames_per_second * job.scene->seconds));
  if (job.options.has_pictures)
    row("--no-render", fmt::format("{:.1f} ms a picture, and the encoder", measured.picture));
  if (job.scene->world.steps_per_second > 240)
    row("--set scene.steps_per_second=240",
        fmt::format("{:.0f} % of the steps", 100.0 * (1.0 - 240.0 / job.scene->world.steps_per_second)));
  if (!job.scene->world.has_sleep) row("--set scene.sleep=true", "what rests costs nothing");
  if (needs("audit")) row("no --audit", "its time after each step");
}

int plan_one(const Options& options, bool is_lean) {
  Recorder recorder;
  scene::Problems problems;
  Job job = make_job(options, recorder, problems);
  if (!problems.empty()) return refuse(problems);
  const std::vector<PartPlan> parts = plan_parts(*job.scene, job.options);
  const std::vector<world::PartCount> made = job.built->world.inventory();
  fmt::print("{}\n", job.scene->name);
  tell_parts(parts, true, "needs");
  tell_parts(parts, false, "leaves out");
  tell_inventory(made);
  tell_tetrahedra(*job.scene, *job.built);
  const Measured measured = measure(job, recorder);
  const std::vector<Foreseen> foreseen = foresee(*job.scene, job.built->plan, kMostTrials);
  tell_foreseen(foreseen, *job.scene);
  tell_expectation(job, measured, foreseen);
  if (is_lean) tell_lean(job, measured, parts);
  return kDone;
}

}  // namespace

int plan_scene(const Options& options, bool is_lean) {
  core::set_thread_count(options.threads);
  int status = kDone;
  for (const std::string& file : scene::shots_or_scene(options.scene)) {
    Options own = options;
    own.scene = file;
    status = std::max(status, plan_one(own, is_lean));
  }
  return status;
}

}  // namespace shatterbox::sandbox::run
