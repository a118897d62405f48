#include "sandbox/study/step_size.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "sandbox/study/scene_play.h"
#include "sandbox/study/step_size_runs.h"
#include "sandbox/study/telling.h"

namespace shatterbox::sandbox::study {

namespace step_size {
namespace {

using world::Criterion;

/// What all tables share.
struct Extent {
  std::vector<int> rates;  // steps a second
  int finest = 7680;       // of the references
  double edge = 0.0042;    // m
  int seeds = 5;
  bool has_dust = true;  // what a penalty breaks into thousands
  double after = 0.05;   // s, behind a hit that breaks
  double rest = 60.0;    // s
  std::shared_ptr<double> paper_duration = std::make_shared<double>(0.0);  // s, found when first asked for
};

StepCase case_of(const Extent& extent, int rate, Criterion criterion) {
  StepCase how{rate, criterion, extent.edge};
  if (criterion != Criterion::paper) return how;
  if (*extent.paper_duration == 0.0)
    *extent.paper_duration =
        find_paper_duration({world::WorldSettings{}.steps_per_second, criterion, extent.edge});
  how.paper_duration = *extent.paper_duration;
  return how;
}

/// A criterion, the end of its tables' names, and how it is named in words.
struct Judged {
  Criterion criterion;
  const char* suffix;
  const char* words;
};
constexpr Judged kAll[] = {{Criterion::event, "", "our criterion"},
                           {Criterion::paper, "-paper", "the paper's criterion"},
                           {Criterion::penalty, "-penalty", "the penalty's snapshots"}};

std::string what_of(const Judged& judged, const char* ours) {
  switch (judged.criterion) {
    case Criterion::paper:
      return "the same under the paper's criterion, all impulses of one step in Pa s, beside its own finer "
             "step";
    case Criterion::penalty:
      return "the same by snapshots of a penalty's force at step borders, beside our criterion at a finer "
             "step";
    default:
      return ours;
  }
}

/// The answer that a criterion's rows are held against, made when first asked for. Penalties tend to ours.
template <class Answer>
class Reference {
 public:
  Reference(const Judged& judged, const Extent& extent, std::function<Answer(const StepCase&)> make)
      : criterion_(judged.criterion == Criterion::paper ? Criterion::paper : Criterion::event),
        extent_(extent),
        make_(std::move(make)) {}
  const Answer& get() {
    if (!answer_) answer_ = make_(case_of(extent_, extent_.finest, criterion_));
    return *answer_;
  }

 private:
  Criterion criterion_;
  Extent extent_;
  std::function<Answer(const StepCase&)> make_;
  std::optional<Answer> answer_;
};

double relative(double found, double expected) {
  return std::abs(found / expected - 1.0);
}

void add_hits(Plan& plan, const Extent& extent) {
  for (const Judged& judged : kAll) {
    const auto reference = std::make_shared<Reference<SoftHit>>(judged, extent, play_soft_hit);
    Table table = rate_table("hit" + std::string(judged.suffix),
                             what_of(judged, "a bauble falls from 8 cm and holds, beside a finer step"),
                             {"stress", "stress / strength", "place (level), of the radius"});
    if (judged.criterion == Criterion::event)
      table.error_names.emplace_back("stress / strength if the impulse is spread over the step");
    add_rates(plan, table, extent.rates, [judged, reference, extent](int rate) {
      const SoftHit hit = play_soft_hit(case_of(extent, rate, judged.criterion));
      const SoftHit& exact = reference->get();
      const Vec3 off = hit.place - exact.place;  // how high the bauble is in that step is not its stress
      Measured measured{
          {relative(hit.ratio, exact.ratio), hit.ratio, std::hypot(off.x(), off.z()) / kBaubleRadius},
          hit.seconds,
          ""};
      if (judged.criterion == Criterion::event) measured.errors.push_back(hit.spread);
      return measured;
    });
  }
}

void add_heights(Plan& plan, const Extent& extent) {
  for (const Judged& judged : kAll) {
    const auto reference = std::make_shared<Reference<BreakingHeight>>(judged, extent, find_breaking_height);
    add_rates(
        plan,
        rate_table("height" + std::string(judged.suffix),
                   what_of(judged,
                           "the height from which the bauble begins to break, sought between 1 mm and "
                           "10 m to 1 %, beside a finer step"),
                   {"height", "height, m"}),
        extent.rates, [judged, reference, extent](int rate) {
          const BreakingHeight found = find_breaking_height(case_of(extent, rate, judged.criterion));
          return Measured{{relative(found.height, reference->get().height), found.height}, found.seconds, ""};
        });
  }
}

void add_breaks(Plan& plan, const Extent& extent) {
  for (const Judged& judged : kAll) {
    if (judged.criterion == Criterion::penalty && !extent.has_dust) continue;
    const auto play = [extent](const StepCase& how) {
      return play_hard_hit(how, extent.seeds, extent.after);
    };
    const auto reference = std::make_shared<Reference<HardHit>>(judged, extent, play);
    Table table = rate_table(
        "break" + std::string(judged.suffix),
        what_of(judged,
                fmt::format("the bauble falls from 1 m and breaks, means over {} flaw seeds, no bound on "
                            "generations, beside a finer step",
                            extent.seeds)
                    .c_str()),
        {"pieces of the first break", "pieces of the first break, number", "stress / strength", "crack area",
         "masses (Kolmogorov)", "pieces at the end, number", "first crack, of the radius off"});
    add_rates(plan, table, extent.rates, [judged, reference, play, extent](int rate) {
      const HardHit found = play(case_of(extent, rate, judged.criterion));
      const HardHit& exact = reference->get();
      const bool is_free = found.guards + found.bounds == 0;
      return Measured{{relative(found.first_pieces, exact.first_pieces), found.first_pieces, found.ratio,
                       relative(found.area, exact.area), distribution_distance(found.masses, exact.masses),
                       judged.criterion == Criterion::penalty ? kNoNumber : found.all_pieces,
                       distance_of_first_cracks(found, exact) / kBaubleRadius},
                      found.seconds,
                      is_free ? ""
                              : fmt::format("energy guard in {} of {} breaks, generation bound in {}",
                                            found.guards, found.breaks, found.bounds)};
    });
  }
}

void add_rests(Plan& plan, const Extent& extent) {
  for (const Judged& judged : kAll) {
    const auto density = std::make_shared<double>(0.0);
    // The paper's criterion solves in every step: fewer triangles.
    const double pane_edge = judged.criterion == Criterion::paper ? 0.05 : 0.025, length = extent.rest;
    const std::string what =
        judged.criterion == Criterion::event
            ? fmt::format(
                  "a ball rests on a pane for {:g} s, at 0.95 and 1.05 of what the pane bears: it must "
                  "hold and break",
                  length)
            : fmt::format(
                  "the same under {} for {:g} s{}", judged.words, length,
                  judged.criterion == Criterion::paper ? ", on a pane of half as fine triangles" : "");
    Table table = rate_table("rest" + std::string(judged.suffix), what,
                             {"wrong verdicts of 2", "breaks at 0.95", "breaks at 1.05"});
    table.is_relative = false;
    table.is_plotted = false;
    table.value_name.clear();
    add_rates(plan, table, extent.rates, [judged, length, pane_edge, density, extent](int rate) {
      if (*density == 0.0) *density = find_critical_density(pane_edge);
      StepCase how = case_of(extent, rate, judged.criterion);
      how.pane_edge = pane_edge;
      Measured measured;
      measured.seconds = 0.0;
      const bool light = does_break_at_rest(how, 0.95 * *density, length, measured.seconds);
      const bool heavy = does_break_at_rest(how, 1.05 * *density, length, measured.seconds);
      measured.errors = {(light ? 1.0 : 0.0) + (heavy ? 0.0 : 1.0), light ? 1.0 : 0.0, heavy ? 1.0 : 0.0};
      return measured;
    });
  }
}

// ---- what follows

/// Least and greatest of a column.
std::pair<double, double> extremes_of(const Table& table, std::size_t column) {
  double low = 1e300, high = -1e300;
  for (const Row& row : table.rows) {
    low = std::min(low, row.errors[column]);
    high = std::max(high, row.errors[column]);
  }
  return {low, high};
}

/// What a table says, of its kind ("hit") and criterion.
std::string sentence_of(const std::string& kind, const Judged& judged, const Table& table, int seeds) {
  const Row &coarse = table.rows.front(), &fine = table.rows.back();
  const std::string steps = fmt::format("{} to {} steps a second", coarse.setting, fine.setting);
  if (kind == "hit") {
    const auto [low, high] = extremes_of(table, 1);
    std::string text = fmt::format("One and the same hit, {}, {}: {:.3g} to {:.3g} strengths.", judged.words,
                                   steps, low, high);
    if (judged.criterion == Criterion::event)
      text += fmt::format(" Its impulse spread over the step would be {:.2g} to {:.2g} strengths.",
                          coarse.errors[3], fine.errors[3]);
    return text;
  }
  if (kind == "height") {
    const auto [low, high] = extremes_of(table, 1);
    return fmt::format("The height from which it begins to break, {}, {}: {:.3g} to {:.3g} m.", judged.words,
                       steps, low, high);
  }
  if (kind == "break") {
    const auto [low, high] = extremes_of(table, 1);
    const double farthest = extremes_of(table, 4).second;
    // Of two samples of one law, that are that large.
    const double chance = 1.36 * std::sqrt(2.0 / (seeds * std::max(1.0, low)));
    return fmt::format(
        "Pieces of the first break, {}: {:.3g} to {:.3g}, {:.3g} at {} steps a second and {:.3g} at {}. "
        "Their "
        "masses are at most {:.2g} from the finer step's (Kolmogorov): {} than what two samples of one law "
        "keep to nineteen times of twenty, {:.2g}.",
        judged.words, low, high, coarse.errors[1], coarse.setting, fine.errors[1], fine.setting, farthest,
        farthest <= chance ? "no more" : "more", chance);
  }
  double wrong = 0.0;
  for (const Row& row : table.rows) wrong += row.errors[0];
  return fmt::format("At rest, {}: {:.0f} of {} verdicts are wrong.", judged.words, wrong,
                     2 * table.rows.size());
}

std::vector<std::string> conclude(const std::vector<Table>& tables, int seeds) {
  std::vector<std::string> sentences;
  for (const char* kind : {"hit", "height", "break", "rest"})
    for (const Judged& judged : kAll)
      for (const Table& table : tables)
        if (table.name == std::string(kind) + judged.suffix && table.rows.size() > 1)
          sentences.push_back(sentence_of(kind, judged, table, seeds));
  return sentences;
}

Plan make_step_size_plan(bool is_quick) {
  Extent extent;
  extent.rates = {30, 60, 120, 240, 480, 960, 1920, 3840};
  if (is_quick) {
    extent.rates = {60, 240, 480};
    extent.finest = 960;
    extent.edge = 0.006;
    extent.seeds = 1;
    extent.has_dust = false;
    extent.after = 0.005;
    extent.rest = 0.3;
  }
  Plan plan;
  add_hits(plan, extent);
  Extent broken = extent;
  if (is_quick) broken.rates = {240};
  add_breaks(plan, broken);
  if (!is_quick) add_heights(plan, extent);
  add_rests(plan, extent);
  plan.conclude = [seeds = extent.seeds](const std::vector<Table>& tables) {
    return conclude(tables, seeds);
  };
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
