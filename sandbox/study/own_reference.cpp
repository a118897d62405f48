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

Run play_at(const scene::SceneDescription& scene, int rate, int samples_a_second) {
  scene::SceneDescription description = scene;
  description.world.steps_per_second = rate;
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

Plan make_scene_plan(const scene::SceneDescription& scene, bool is_quick) {
  const int usual = scene.world.steps_per_second;
  const int coarse = std::max(1, usual / 2), finest = usual * (is_quick ? 2 : 8);
  Plan plan;
  Table table;
  table.name = scene.name;
  table.what = fmt::format("{} s beside {} steps a second", scene.seconds, finest);
  table.setting_name = "steps a second";
  table.value_name = "step, s";
  table.error_names = {"trajectories before the first break",
                       "first break, s",
                       "masses at the end (Kolmogorov)",
                       "pieces",
                       "breaks",
                       "greatest energy rise, J",
                       "unexplained momentum, N s",
                       "failsafe steps"};
  const auto description = std::make_shared<scene::SceneDescription>(scene);
  const auto reference = std::make_shared<std::unique_ptr<Run>>();
  const int samples = std::min(coarse, 60);
  const auto measure = [description, reference, finest, samples](int rate) {
    if (!*reference) *reference = std::make_unique<Run>(play_at(*description, finest, samples));
    return beside(play_at(*description, rate, samples), **reference);
  };
  std::vector<int> rates{coarse, usual};
  if (!is_quick) rates.insert(rates.end(), {2 * usual, 4 * usual});
  for (const int rate : rates)
    plan.jobs.push_back(
        {0, std::to_string(rate), 1.0 / rate, rate == usual, [measure, rate] { return measure(rate); }});
  plan.tables.push_back(std::move(table));
  return plan;
}

}  // namespace
}  // namespace own_reference

Study scene_study(const scene::SceneDescription& description) {
  return {description.name, description.goal,
          [description](bool is_quick) { return own_reference::make_scene_plan(description, is_quick); }};
}

}  // namespace shatterbox::sandbox::study
