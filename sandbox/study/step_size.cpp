#include "sandbox/study/step_size.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include <fmt/format.h>

#include "sandbox/study/scene_play.h"
#include "sandbox/study/scene_texts.h"
#include "sandbox/study/telling.h"

namespace shatterbox::sandbox::study {

namespace step_size {
namespace {

constexpr double kSize = 0.04;  // m, radius of the bauble

// A steel ball lies in the middle of a pane that is held at its border, at the gap that is kept.
const char* const kRest = R"([scene]
sleep = false
[[body]]
name = "pane"
kind = "shell"
shape = "pane"
width = 0.5
height = 0.5
edge_length = 0.025
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

const char* word_of(world::Criterion criterion) {
  return criterion == world::Criterion::paper ? "paper" : "event";
}

Overrides scene_overrides(int rate, world::Criterion criterion) {
  return {fmt::format("scene.steps_per_second={}", rate),
          fmt::format("scene.criterion=\"{}\"", word_of(criterion))};
}

/// The drop from a height of the centre above touching, m, until `after` seconds behind the hit.
ScenePlay drop(int rate, world::Criterion criterion, double height, double after, int seed, double edge) {
  Overrides overrides = scene_overrides(rate, criterion);
  overrides.push_back(fmt::format("scene.seed={}", seed));
  overrides.push_back(fmt::format("whole.edge_length={}", edge));
  overrides.push_back(fmt::format("whole.position=[0, {}, 0]", kSize + height));
  ScenePlay play(scene_of(kBaubleText, overrides));
  play.play_until(std::ceil((std::sqrt(2.0 * height / 9.81) + after) * 30.0) / 30.0);
  return play;
}

// ---- an impact that is borne

struct Hit {
  double ratio = 0.0;          // of stress to strength
  double instantaneous = 0.0;  // the same, had the impulse been spread over the step
  Vec3 place = Vec3::Zero();   // m
  double seconds = 0.0;
};

Hit soft_hit(int rate, world::Criterion criterion, double edge) {
  ScenePlay play = drop(rate, criterion, 0.08, 0.02, 12, edge);
  const auto& impacts = play.world().report().impacts;
  Hit hit;
  hit.seconds = play.seconds();
  if (impacts.empty()) throw std::runtime_error("the bauble met nothing");
  hit.ratio = impacts[0].ratio;
  hit.instantaneous = impacts[0].ratio * impacts[0].duration * rate;
  hit.place = impacts[0].place;
  return hit;
}

/// Answers of a finer step than all that are shown, made when they are first asked for.
template <class Answer>
class References {
 public:
  explicit References(std::function<Answer(world::Criterion)> make) : make_(std::move(make)) {}
  const Answer& of(world::Criterion criterion) {
    const auto found = known_.find(criterion);
    return found != known_.end() ? found->second : known_.emplace(criterion, make_(criterion)).first->second;
  }

 private:
  std::function<Answer(world::Criterion)> make_;
  std::map<world::Criterion, Answer> known_;
};

// ---- an impact that breaks

struct Broken {
  double first_pieces = 0.0, all_pieces = 0.0, area = 0.0;  // means over the seeds; m2
  std::vector<double> masses;                               // of the first break's pieces, of all seeds, kg
  Vec3 place = Vec3::Zero();                                // of the first hit, m
  int guards = 0, bounds = 0, breaks = 0;  // breaks with an active energy guard, generation bound
  double seconds = 0.0;
};

Broken hard_hit(int rate, world::Criterion criterion, int seeds, double after, double edge) {
  Broken broken;
  for (int seed = 1; seed <= seeds; ++seed) {
    ScenePlay play = drop(rate, criterion, 1.0, after, seed, edge);
    const auto& report = play.world().report();
    broken.seconds += play.seconds() / seeds;
    for (const world::BreakRow& row : report.breaks) {
      ++broken.breaks;
      broken.guards += row.energy_guard_active ? 1 : 0;
      broken.bounds += row.generation_bound_active ? 1 : 0;
    }
    if (!report.impacts.empty()) broken.place += report.impacts[0].place / seeds;
    if (report.breaks.empty()) continue;
    const world::BreakRow& first = report.breaks[0];
    broken.first_pieces += static_cast<double>(first.pieces) / seeds;
    broken.area += first.new_area / seeds;
    for (const auto& shape : first.shapes) broken.masses.push_back(shape->mass);
    for (const body::Body& body : play.world().bodies())
      if (play.world().ancestry(body.id).parent != 0) broken.all_pieces += 1.0 / seeds;
  }
  return broken;
}

// ---- the height at which it begins to break

struct Height {
  double height = 0.0;  // m, of the centre above touching
  double seconds = 0.0;
};

Height breaking_height(int rate, world::Criterion criterion, double edge) {
  Height found;
  double held = 0.02, broke = 5.0;
  for (int halving = 0; halving < 9; ++halving) {
    const double height = std::sqrt(held * broke);
    ScenePlay play = drop(rate, criterion, height, 0.0, 12, edge);
    found.seconds += play.seconds();
    (play.world().report().breaks.empty() ? held : broke) = height;
  }
  found.height = std::sqrt(held * broke);
  return found;
}

// ---- what rests

/// Whether the pane broke under a ball whose static stress is `share` of the strength.
bool breaks_at_rest(int rate, world::Criterion criterion, double share, double length, double unit,
                    double& seconds) {
  Overrides overrides = scene_overrides(rate, criterion);
  overrides.push_back(fmt::format("ball.density={}", unit * share));
  ScenePlay play(scene_of(kRest, overrides));
  const long last = std::lround(length * rate);
  while (play.world().steps() < last && play.world().report().breaks.empty()) play.step();
  seconds += play.seconds();
  return !play.world().report().breaks.empty();
}

/// The density (kg/m3) of a ball whose weight brings the pane to its strength: from the stress of a light
/// one, which is in proportion.
double critical_density() {
  const double light = 20000.0;
  Overrides overrides = scene_overrides(60, world::Criterion::event);
  overrides.push_back(fmt::format("ball.density={}", light));
  ScenePlay play(scene_of(kRest, overrides));
  play.play_until(0.5);
  double ratio = 0.0;
  for (const world::ImpactRow& row : play.world().report().impacts) ratio = std::max(ratio, row.ratio);
  if (!(ratio > 0.0)) throw std::runtime_error("the ball at rest was not judged");
  return light / ratio;
}

// ---- tables

double relative(double found, double expected) {
  return std::abs(found / expected - 1.0);
}

void add_soft(Plan& plan, const std::vector<int>& rates, int finest, double edge) {
  const auto references = std::make_shared<References<Hit>>(
      [finest, edge](world::Criterion c) { return soft_hit(finest, c, edge); });
  for (const auto criterion : {world::Criterion::event, world::Criterion::paper}) {
    const bool is_paper = criterion == world::Criterion::paper;
    add_rates(
        plan,
        rate_table(is_paper ? "hit-paper" : "hit",
                   is_paper ? "the same hit under the paper's criterion, all impulses of one step in Pa s"
                            : "a bauble falls from 8 cm and holds, beside a finer step",
                   {"stress", "stress / strength", "place, of the radius",
                    "stress / strength if the impulse is spread over the step"}),
        rates, [criterion, references, edge](int rate) {
          const Hit &hit = soft_hit(rate, criterion, edge), &exact = references->of(criterion);
          return Measured{
              {relative(hit.ratio, exact.ratio), hit.ratio, (hit.place - exact.place).norm() / kSize,
               criterion == world::Criterion::paper ? kNoNumber : hit.instantaneous},
              hit.seconds,
              ""};
        });
  }
}

void add_heights(Plan& plan, const std::vector<int>& rates, int finest, double edge) {
  const auto references = std::make_shared<References<Height>>(
      [finest, edge](world::Criterion c) { return breaking_height(finest, c, edge); });
  for (const auto criterion : {world::Criterion::event, world::Criterion::paper}) {
    const bool is_paper = criterion == world::Criterion::paper;
    add_rates(
        plan,
        rate_table(is_paper ? "height-paper" : "height",
                   is_paper ? "the same under the paper's criterion"
                            : "the height from which the bauble begins to break, between 2 cm and 5 m to "
                              "1 %, beside a finer step",
                   {"height", "height, m"}),
        rates, [criterion, references, edge](int rate) {
          const Height found = breaking_height(rate, criterion, edge);
          return Measured{
              {relative(found.height, references->of(criterion).height), found.height}, found.seconds, ""};
        });
  }
}

void add_hard(Plan& plan, const std::vector<int>& rates, int finest, int seeds, double after, double edge) {
  const auto references = std::make_shared<References<Broken>>(
      [finest, seeds, after, edge](world::Criterion c) { return hard_hit(finest, c, seeds, after, edge); });
  add_rates(
      plan,
      rate_table("break", "the bauble falls from 1 m and breaks, means over flaw seeds, beside a finer step",
                 {"pieces of the first break", "pieces of the first break, number", "crack area",
                  "masses (Kolmogorov)", "pieces at the end, number", "place, of the radius"}),
      rates, [references, seeds, after, edge](int rate) {
        const Broken& found = hard_hit(rate, world::Criterion::event, seeds, after, edge);
        const Broken& exact = references->of(world::Criterion::event);
        return Measured{{relative(found.first_pieces, exact.first_pieces), found.first_pieces,
                         relative(found.area, exact.area), distribution_distance(found.masses, exact.masses),
                         found.all_pieces, (found.place - exact.place).norm() / kSize},
                        found.seconds,
                        found.guards + found.bounds == 0
                            ? ""
                            : fmt::format("energy guard in {} of {} breaks, generation bound in {}",
                                          found.guards, found.breaks, found.bounds)};
      });
}

void add_rest(Plan& plan, const std::vector<int>& rates, double length) {
  const auto density = std::make_shared<double>(0.0);
  for (const auto criterion : {world::Criterion::event, world::Criterion::paper}) {
    const bool is_paper = criterion == world::Criterion::paper;
    Table table = rate_table(
        is_paper ? "rest-paper" : "rest",
        is_paper ? "the same under the paper's criterion"
                 : "a ball rests on a pane for as long as it takes, at 0.95 and 1.05 of what the pane "
                   "bears: it must hold and break",
        {"wrong verdicts of 2", "breaks at 0.95", "breaks at 1.05"});
    table.is_relative = false;
    table.is_plotted = false;
    table.value_name.clear();
    add_rates(plan, table, rates, [criterion, length, density](int rate) {
      if (*density == 0.0) *density = critical_density();
      Measured measured;
      measured.seconds = 0.0;
      const bool light = breaks_at_rest(rate, criterion, 0.95, length, *density, measured.seconds);
      const bool heavy = breaks_at_rest(rate, criterion, 1.05, length, *density, measured.seconds);
      measured.errors = {(light ? 1.0 : 0.0) + (heavy ? 0.0 : 1.0), light ? 1.0 : 0.0, heavy ? 1.0 : 0.0};
      return measured;
    });
  }
}

std::vector<std::string> conclude(const std::vector<Table>& tables) {
  std::vector<std::string> sentences;
  for (const Table& table : tables) {
    if (table.rows.size() < 2) continue;
    const Row &coarse = table.rows.front(), &fine = table.rows.back();
    if (table.name == "hit")
      sentences.push_back(fmt::format(
          "From {} to {} steps a second the stress of one and the same hit changes by at most {}; spread "
          "over the step "
          "instead, it would go from {:.2g} to {:.2g} strengths.",
          coarse.setting, fine.setting,
          percent(std::max_element(table.rows.begin(), table.rows.end(),
                                   [](const Row& a, const Row& b) { return a.errors[0] < b.errors[0]; })
                      ->errors[0]),
          coarse.errors[3], fine.errors[3]));
    if (table.name == "rest" || table.name == "rest-paper") {
      double wrong = 0.0;
      for (const Row& row : table.rows) wrong += row.errors[0];
      sentences.push_back(fmt::format("At rest, {}: {:.0f} of {} verdicts are wrong.",
                                      table.name == "rest" ? "our criterion" : "the paper's criterion", wrong,
                                      2 * table.rows.size()));
    }
    if (table.name == "height" || table.name == "height-paper") {
      const auto [low, high] =
          std::minmax_element(table.rows.begin(), table.rows.end(),
                              [](const Row& a, const Row& b) { return a.errors[1] < b.errors[1]; });
      sentences.push_back(fmt::format("It begins to break at {:.3g} to {:.3g} m over these steps{}.",
                                      low->errors[1], high->errors[1],
                                      table.name == "height" ? "" : " under the paper's criterion"));
    }
    if (table.name == "break")
      sentences.push_back(fmt::format(
          "The first break has {:.3g} pieces at {} steps a second and {:.3g} at {}; 50 ms later there are "
          "{:.3g} and {:.3g}.",
          coarse.errors[1], coarse.setting, fine.errors[1], fine.setting, coarse.errors[4], fine.errors[4]));
  }
  return sentences;
}

Plan make_step_size_plan(bool is_quick) {
  const std::vector<int> rates =
      is_quick ? std::vector<int>{60, 240, 480} : std::vector<int>{30, 60, 120, 240, 480, 960, 1920, 3840};
  const int finest = is_quick ? 960 : 7680;
  Plan plan;
  const double edge = is_quick ? 0.006 : 0.0042;  // m
  add_soft(plan, rates, finest, edge);
  add_hard(plan, is_quick ? std::vector<int>{240} : rates, finest, is_quick ? 1 : 5, is_quick ? 0.005 : 0.05,
           edge);
  if (!is_quick) add_heights(plan, rates, finest, edge);
  add_rest(plan, rates, is_quick ? 0.3 : 60.0);
  plan.conclude = conclude;
  return plan;
}

}  // namespace
}  // namespace step_size

Study step_size_study() {
  return {"step-size",
          "one drop, and one load at rest, at 30 to 3840 steps a second: the verdict must not depend on it",
          step_size::make_step_size_plan};
}

}  // namespace shatterbox::sandbox::study
