#include "sandbox/study/step_size_runs.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "sandbox/study/scene_play.h"
#include "sandbox/study/scene_texts.h"

namespace shatterbox::sandbox::study {

namespace {

// A steel ball lies in the middle of a pane that is held at its border, at the gap that is kept.
const char* const kRestText = R"([scene]
sleep = false
[[body]]
name = "pane"
kind = "shell"
shape = "pane"
width = 0.5
height = 0.5
rotation = [-90, 0, 0]
material = "glass"
thickness = 0.003
support = "edge"
[[body]]
name = "ball"
kind = "sphere"
radius = 0.05
material = "steel"
position = [0, 0.05005, 0]
)";

constexpr int kUnbounded = 100;  // generations: no break of the study is ended by their number
constexpr double kSoftHeight = 0.08, kHardHeight = 1.0;  // m
constexpr double kLowest = 0.001, kHighest = 10.0;       // m, that a breaking height is sought between
constexpr int kHalvings = 10;                            // of the logarithm of their ratio: to 1 %

const char* word_of(world::Criterion criterion) {
  switch (criterion) {
    case world::Criterion::paper:
      return "paper";
    case world::Criterion::penalty:
      return "penalty";
    default:
      return "event";
  }
}

Overrides overrides_of(const StepCase& how) {
  return {fmt::format("scene.steps_per_second={}", how.rate),
          fmt::format("scene.criterion=\"{}\"", word_of(how.criterion)),
          fmt::format("scene.paper_duration={}", how.paper_duration)};
}

/// The bauble at a height of the centre above touching, m, with that speed downwards, m/s.
ScenePlay bauble(const StepCase& how, double height, double speed, int seed) {
  Overrides overrides = overrides_of(how);
  overrides.push_back(fmt::format("scene.seed={}", seed));
  overrides.push_back(fmt::format("whole.edge_length={}", how.edge));
  overrides.push_back(fmt::format("whole.position=[0, {}, 0]", kBaubleRadius + height));
  overrides.push_back(fmt::format("whole.velocity=[0, {}, 0]", -speed));
  if (how.criterion == world::Criterion::penalty) overrides.emplace_back("scene.after_break=\"inherit\"");
  scene::SceneDescription description = scene_of(kBaubleText, overrides);
  world::WorldSettings& settings = description.world;
  settings.crack_generations = settings.piece_generations = settings.most_generations = kUnbounded;
  return ScenePlay(std::move(description));
}

double fall_time(double height) {
  return std::sqrt(2.0 * height / 9.81);
}

/// Long enough for any step to meet the floor.
double until_after(double fall, double after) {
  return std::ceil((fall + after) * 30.0) / 30.0;
}

}  // namespace

SoftHit play_soft_hit(const StepCase& how) {
  ScenePlay play = bauble(how, kSoftHeight, 0.0, 12);
  const double end = until_after(fall_time(kSoftHeight), 0.02);
  const auto& impacts = play.world().report().impacts;
  while (play.world().time() < end && impacts.empty()) play.step();
  if (impacts.empty()) throw std::runtime_error("the bauble met nothing");
  return {impacts[0].ratio, impacts[0].ratio * impacts[0].duration * how.rate, impacts[0].place,
          play.seconds()};
}

double find_paper_duration(const StepCase& how) {
  StepCase paper = how;
  paper.criterion = world::Criterion::paper;
  StepCase ours = how;
  ours.criterion = world::Criterion::event;
  return how.paper_duration * play_soft_hit(paper).ratio / play_soft_hit(ours).ratio;
}

HardHit play_hard_hit(const StepCase& how, int seeds, double after) {
  HardHit hit;
  for (int seed = 1; seed <= seeds; ++seed) {
    ScenePlay play = bauble(how, kHardHeight, 0.0, seed);
    // The springs of a penalty hold thousands of times the energy that there is: pieces that met the floor
    // again would be dust.
    const bool is_first_alone = how.criterion == world::Criterion::penalty;
    const double end = until_after(fall_time(kHardHeight), after);
    while (play.world().time() < end - 1e-9 && !(is_first_alone && !play.world().report().breaks.empty()))
      play.step();
    const auto& report = play.world().report();
    hit.seconds += play.seconds() / seeds;
    for (const world::BreakRow& row : report.breaks) {
      ++hit.breaks;
      hit.guards += row.energy_guard_active ? 1 : 0;
      hit.bounds += row.generation_bound_active ? 1 : 0;
    }
    for (const world::ImpactRow& row : report.impacts)
      hit.bounds += row.verdict.find("used all its generations") != std::string::npos ? 1 : 0;
    if (!report.impacts.empty()) hit.ratio += report.impacts[0].ratio / seeds;
    if (report.breaks.empty()) continue;
    const world::BreakRow& first = report.breaks[0];
    hit.places.push_back(first.cracks.empty() ? first.place_material : first.cracks.front()[0]);
    hit.first_pieces += static_cast<double>(first.pieces) / seeds;
    hit.area += first.new_area / seeds;
    for (const auto& shape : first.shapes) hit.masses.push_back(shape->mass);
    for (const body::Body& body : play.world().bodies())
      if (play.world().ancestry(body.id).parent != 0) hit.all_pieces += 1.0 / seeds;
  }
  return hit;
}

double distance_of_first_cracks(const HardHit& a, const HardHit& b) {
  const std::size_t count = std::min(a.places.size(), b.places.size());
  double sum = 0.0;
  for (std::size_t i = 0; i < count; ++i) sum += (a.places[i] - b.places[i]).norm();
  return count > 0 ? sum / static_cast<double>(count) : std::nan("");
}

BreakingHeight find_breaking_height(const StepCase& how) {
  BreakingHeight found;
  double held = kLowest, broke = kHighest;
  for (int halving = 0; halving < kHalvings; ++halving) {
    const double height = std::sqrt(held * broke);
    // The last 2 cm are enough: the rest is free flight, in which no step errs.
    const double last = std::min(height, 0.02);
    ScenePlay play = bauble(how, last, std::sqrt(2.0 * 9.81 * (height - last)), 12);
    const double end = until_after(fall_time(last), 0.0);
    while (play.world().time() < end && play.world().report().breaks.empty()) play.step();
    found.seconds += play.seconds();
    (play.world().report().breaks.empty() ? held : broke) = height;
  }
  found.height = std::sqrt(held * broke);
  return found;
}

double find_critical_density(double pane_edge) {
  const double light = 20000.0;  // kg/m3: what it does to the pane is in proportion
  Overrides overrides = overrides_of({60, world::Criterion::event});
  overrides.push_back(fmt::format("pane.edge_length={}", pane_edge));
  overrides.push_back(fmt::format("ball.density={}", light));
  ScenePlay play(scene_of(kRestText, overrides));
  play.play_until(0.5);
  double ratio = 0.0;
  for (const world::ImpactRow& row : play.world().report().impacts) ratio = std::max(ratio, row.ratio);
  if (!(ratio > 0.0)) throw std::runtime_error("the ball at rest was not judged");
  return light / ratio;
}

bool does_break_at_rest(const StepCase& how, double density, double length, double& seconds) {
  Overrides overrides = overrides_of(how);
  overrides.push_back(fmt::format("ball.density={}", density));
  overrides.push_back(fmt::format("pane.edge_length={}", how.pane_edge));
  ScenePlay play(scene_of(kRestText, overrides));
  const long last = std::lround(length * how.rate);
  while (play.world().steps() < last && play.world().report().breaks.empty()) play.step();
  seconds += play.seconds();
  return !play.world().report().breaks.empty();
}

}  // namespace shatterbox::sandbox::study
