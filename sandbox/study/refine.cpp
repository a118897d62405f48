#include "sandbox/study/refine.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include <fmt/format.h>

#include "sandbox/study/scene_play.h"
#include "sandbox/study/scene_texts.h"
#include "sandbox/study/telling.h"

namespace shatterbox::sandbox::study {

namespace refine {
namespace {

/// The first break, over flaw seeds.
struct Break {
  double pieces = 0.0, pieces_scatter = 0.0;  // mean, standard deviation
  double area = 0.0;                          // m2
  double energy_share = 0.0;                  // of the elastic energy that the cracks use
  int guarded = 0;                            // breaks with an active energy guard
  double triangles = 0.0;
  std::vector<double> masses;  // kg, of all seeds
  double seconds = 0.0;
};

Break first_breaks(const Overrides& motion, const char* text, double edge, int seeds) {
  Break found;
  double squares = 0.0;
  for (int seed = 1; seed <= seeds; ++seed) {
    Overrides overrides = motion;
    overrides.insert(overrides.end(), {"scene.after_break=\"inherit\"", fmt::format("scene.seed={}", seed),
                                       fmt::format("whole.edge_length={}", edge)});
    ScenePlay play(scene_of(text, overrides));
    for (const body::Body& body : play.world().bodies())
      found.triangles += static_cast<double>(body.shape->surface.triangles.size()) / seeds;
    while (play.world().time() < 0.1 && play.world().report().breaks.empty()) play.step();
    found.seconds += play.seconds() / seeds;
    if (play.world().report().breaks.empty()) continue;
    const world::BreakRow& row = play.world().report().breaks[0];
    found.pieces += static_cast<double>(row.pieces) / seeds;
    squares += static_cast<double>(row.pieces) * row.pieces / seeds;
    found.area += row.new_area / seeds;
    found.energy_share += row.fracture_energy / row.elastic_energy / seeds;
    found.guarded += row.energy_guard_active ? 1 : 0;
    for (const auto& shape : row.shapes) found.masses.push_back(shape->mass);
  }
  found.pieces_scatter = std::sqrt(std::max(0.0, squares - found.pieces * found.pieces));
  return found;
}

void add_body(Plan& plan, const char* name, const std::string& what, const char* text,
              const Overrides& motion, const std::vector<double>& edges, double finest, double usual,
              int seeds) {
  Table table;
  table.name = name;
  table.what = what;
  table.setting_name = "mm an edge";
  table.value_name = "edge, m";
  table.error_names = {"crack area",        "crack area, cm2",     "pieces",
                       "scatter of pieces", "masses (Kolmogorov)", "energy used of the elastic",
                       "triangles"};
  const auto reference = std::make_shared<std::unique_ptr<Break>>();
  const auto measure = [reference, text, motion, finest, seeds](double edge) {
    if (!*reference) *reference = std::make_unique<Break>(first_breaks(motion, text, finest, seeds));
    const Break found = first_breaks(motion, text, edge, seeds), &exact = **reference;
    return Measured{
        {std::abs(found.area / exact.area - 1.0), 1e4 * found.area, found.pieces, found.pieces_scatter,
         distribution_distance(found.masses, exact.masses), found.energy_share, found.triangles},
        found.seconds,
        found.guarded > 0 ? fmt::format("energy guard in {} of {} breaks", found.guarded, seeds) : ""};
  };
  for (const double edge : edges)
    plan.jobs.push_back({plan.tables.size(), fmt::format("{:g}", 1e3 * edge), edge, edge == usual,
                         [measure, edge] { return measure(edge); }});
  plan.tables.push_back(std::move(table));
}

bool has_same_errors(const Table& a, const Table& b) {
  return std::equal(a.rows.begin(), a.rows.end(), b.rows.begin(), b.rows.end(),
                    [](const Row& x, const Row& y) { return x.errors == y.errors; });
}

std::vector<std::string> conclude(const std::vector<Table>& tables) {
  std::vector<std::string> sentences;
  for (const Table& table : tables) {
    if (table.rows.empty()) continue;
    const Row &coarse = table.rows.front(), &fine = table.rows.back();
    sentences.push_back(
        fmt::format("{}: {:.3g} pieces (scatter {:.2g}) at {} mm, {:.3g} ({:.2g}) at {} mm; the cracks use "
                    "{} and {} of the elastic energy.",
                    table.name, coarse.errors[2], coarse.errors[3], coarse.setting, fine.errors[2],
                    fine.errors[3], fine.setting, percent(coarse.errors[5]), percent(fine.errors[5])));
  }
  for (const Table& table : tables)
    for (const Table& other : tables)
      if (other.name == table.name + "-unguarded" && has_same_errors(table, other))
        sentences.push_back(fmt::format("The energy guard changed nothing in {}.", table.name));
  return sentences;
}

Plan make_refine_plan(bool is_quick) {
  Plan plan;
  const Overrides falls{"whole.position=[0, 0.05, 0]", "whole.velocity=[0, -4.4, 0]"};
  const auto unguarded = [](Overrides motion) {
    motion.push_back("scene.energy_guard=false");
    return motion;
  };
  if (is_quick) {
    add_body(plan, "bauble", "a bauble hits the floor at 4.4 m/s, mean of 2 flaw seeds, beside edges of 3 mm",
             kBaubleText, falls, {0.006, 0.0042}, 0.003, 0.0042, 2);
  } else {
    const char* const bauble =
        "a bauble hits the floor at 4.4 m/s, means over 6 flaw seeds, beside edges of 1.5 mm";
    const char* const pane =
        "a steel ball of 1 kg hits a held pane at 10 m/s, means over 6 flaw seeds, beside edges of 10 mm";
    const std::vector<double> bauble_edges{0.006, 0.0042, 0.003, 0.0021};
    const std::vector<double> pane_edges{0.06, 0.042, 0.03, 0.021, 0.015};
    const Overrides shot{"ball.velocity=[0, 0, -10]"};
    add_body(plan, "bauble", bauble, kBaubleText, falls, bauble_edges, 0.0015, 0.0042, 6);
    add_body(plan, "bauble-unguarded", std::string("without the energy guard: ") + bauble, kBaubleText,
             unguarded(falls), bauble_edges, 0.0015, 0.0042, 6);
    add_body(plan, "window", pane, kHeldPaneText, shot, pane_edges, 0.01, 0.03, 6);
    add_body(plan, "window-unguarded", std::string("without the energy guard: ") + pane, kHeldPaneText,
             unguarded(shot), pane_edges, 0.01, 0.03, 6);
  }
  plan.conclude = conclude;
  return plan;
}

}  // namespace
}  // namespace refine

Study refine_study() {
  return {"refine", "pieces and crack area while elements get smaller, means over flaw seeds",
          refine::make_refine_plan};
}

}  // namespace shatterbox::sandbox::study
