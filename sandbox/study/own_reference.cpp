#include "sandbox/study/own_reference.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include <fmt/format.h>

#include "sandbox/study/scene_play.h"

namespace shatterbox::sandbox::study {

namespace own_reference {
namespace {

constexpr double kNever = 1e300;  // s

/// One run: where bodies were at common moments, and what was left.
struct Run {
  std::vector<double> times;                         // s
  std::vector<std::map<body::BodyId, Vec3>> places;  // m, of bodies of the scene that can move
  double first_break = kNever;                       // s
  std::vector<double> masses;                        // kg, of what can move, at the end
  double pieces = 0.0, breaks = 0.0;
  double seconds = 0.0;
  double energy_rise = 0.0, momentum_error = 0.0, failsafe = 0.0;
};

Run play_with(const scene::SceneDescription& scene, const world::WorldSettings& settings,
              int samples_a_second) {
  scene::SceneDescription description = scene;
  description.world = settings;
  ScenePlay play(std::move(description));
  Run run;
  const auto samples = static_cast<long>(scene.seconds * samples_a_second + 0.5);
  for (long i = 1; i <= samples; ++i) {
    const double time = static_cast<double>(i) / samples_a_second;
    play.play_until(time);
    run.times.push_back(time);
    auto& places = run.places.emplace_back();
    for (const body::Body& body : play.world().bodies())
      if (body.is_dynamic() && play.world().ancestry(body.id).parent == 0)
        places[body.id] = body.pose.translation;
  }
  const auto& report = play.world().report();
  if (!report.breaks.empty()) run.first_break = report.breaks[0].time;
  for (const body::Body& body : play.world().bodies()) {
    if (!body.is_dynamic()) continue;
    run.masses.push_back(body.shape->mass);
    if (play.world().ancestry(body.id).parent != 0) run.pieces += 1.0;
  }
  run.breaks = static_cast<double>(report.breaks.size());
  run.seconds = play.seconds();
  run.energy_rise = report.conservation.greatest_energy_rise;
  run.momentum_error = report.conservation.momentum_error;
  run.failsafe = static_cast<double>(report.contact.failsafe_steps);
  return run;
}

/// Root of the mean square distance of bodies until either run broke something, over the same of how far they
/// had gone from where they were first seen; NaN if nothing moved.
double trajectory_error(const Run& run, const Run& exact) {
  const double until = std::min(run.first_break, exact.first_break);
  std::map<body::BodyId, Vec3> starts;
  double error = 0.0, way = 0.0;
  for (std::size_t i = 0; i < exact.times.size() && i < run.times.size(); ++i) {
    if (exact.times[i] > until) break;
    for (const auto& [id, place] : exact.places[i]) {
      const auto other = run.places[i].find(id);
      if (other == run.places[i].end()) continue;
      const Vec3& start = starts.emplace(id, place).first->second;
      error += (other->second - place).squaredNorm();
      way += (place - start).squaredNorm();
    }
  }
  return way > 0.0 ? std::sqrt(error / way) : kNoNumber;
}

Measured beside(const Run& run, const Run& exact) {
  const bool broke = run.first_break < kNever, should = exact.first_break < kNever;
  const double late = broke && should ? std::abs(run.first_break - exact.first_break) : kNoNumber;
  return {{trajectory_error(run, exact), late, distribution_distance(run.masses, exact.masses), run.pieces,
           run.breaks, run.energy_rise, run.momentum_error, run.failsafe},
          run.seconds,
          broke == should ? ""
          : broke         ? "breaks, the reference does not"
                          : "does not break, the reference does"};
}

/// A table of the scene beside itself at its finest setting: one setting is varied by `set`.
template <class Value>
struct Varied {
  std::string name;          // behind the scene's; empty: the scene's own
  std::string setting_name;  // "steps a second"
  std::string value_name;    // of what the error is an order of
  std::vector<Value> values;
  Value usual, finest;
  double (*value_of)(Value);
  void (*set)(world::WorldSettings&, Value);
};

template <class Value>
void add_varied(Plan& plan, const scene::SceneDescription& scene, int samples, const Varied<Value>& varied) {
  Table table;
  table.name = scene.name + varied.name;
  table.what = fmt::format("{} s beside {:g} {}", scene.seconds, static_cast<double>(varied.finest),
                           varied.setting_name);
  table.setting_name = varied.setting_name;
  table.value_name = varied.value_name;
  table.error_names = {"trajectories before the first break",
                       "first break off by, s",
                       "masses at the end (Kolmogorov)",
                       "pieces",
                       "breaks",
                       "greatest energy rise, J",
                       "unexplained momentum, N s",
                       "failsafe steps"};
  const auto description = std::make_shared<scene::SceneDescription>(scene);
  const auto reference = std::make_shared<std::unique_ptr<Run>>();
  const auto play = [description, samples, set = varied.set](Value value) {
    world::WorldSettings settings = description->world;
    set(settings, value);
    return play_with(*description, settings, samples);
  };
  for (const Value value : varied.values)
    plan.jobs.push_back({plan.tables.size(), fmt::format("{:g}", static_cast<double>(value)),
                         varied.value_of(value), value == varied.usual,
                         [play, reference, value, finest = varied.finest] {
                           if (!*reference) *reference = std::make_unique<Run>(play(finest));
                           return beside(play(value), **reference);
                         }});
  plan.tables.push_back(std::move(table));
}

bool has_breakable_solids(const scene::SceneDescription& scene) {
  ScenePlay play{scene::SceneDescription(scene)};
  const auto bodies = play.world().bodies();
  return std::any_of(bodies.begin(), bodies.end(), [](const body::Body& body) {
    return body.shape->kind == body::ShapeKind::solid && body.is_dynamic();
  });
}

Plan make_scene_plan(const scene::SceneDescription& scene, bool is_quick) {
  const int usual = scene.world.steps_per_second;
  const int coarse = std::max(1, usual / 2), finest = usual * (is_quick ? 2 : 8);
  const int samples = std::min(coarse, 60);
  Plan plan;
  Varied<int> steps{"",
                    "steps a second",
                    "step, s",
                    {coarse, usual},
                    usual,
                    finest,
                    [](int rate) { return 1.0 / rate; },
                    [](world::WorldSettings& s, int rate) { s.steps_per_second = rate; }};
  if (!is_quick) steps.values.insert(steps.values.end(), {2 * usual, 4 * usual});
  add_varied(plan, scene, samples, steps);
  const int substeps = scene.world.substeps;
  Varied<int> parts{"-substeps",
                    "substeps a step",
                    "substep, of a step",
                    {substeps / 2, substeps},
                    substeps,
                    is_quick ? 2 * substeps : 8 * substeps,
                    [](int count) { return 1.0 / count; },
                    [](world::WorldSettings& s, int count) { s.substeps = count; }};
  if (!is_quick) parts.values = {substeps / 4, substeps / 2, substeps, 2 * substeps, 4 * substeps};
  add_varied(plan, scene, samples, parts);
  if (!has_breakable_solids(scene)) return plan;  // shells are solved to rounding
  const double residual = scene.world.solve_residual;
  Varied<double> solves{"-residual",
                        "residual of the stress solves",
                        "residual",
                        {10.0 * residual, residual},
                        residual,
                        1e-4 * residual,
                        [](double value) { return value; },
                        [](world::WorldSettings& s, double value) { s.solve_residual = value; }};
  if (!is_quick) solves.values.push_back(0.1 * residual);
  add_varied(plan, scene, samples, solves);
  return plan;
}

}  // namespace
}  // namespace own_reference

Study scene_study(const scene::SceneDescription& description) {
  return {description.name, description.goal,
          [description](bool is_quick) { return own_reference::make_scene_plan(description, is_quick); }};
}

}  // namespace shatterbox::sandbox::study
