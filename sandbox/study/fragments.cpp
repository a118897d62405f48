#include "sandbox/study/fragments.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "sandbox/study/order.h"
#include "sandbox/study/scene_play.h"
#include "sandbox/study/scene_texts.h"
#include "sandbox/study/telling.h"

namespace shatterbox::sandbox::study {

namespace fragments {
namespace {

// A closed brittle shell falls on stone.
const char* const kShell = R"([[body]]
name = "floor"
kind = "plane"
material = "concrete"
[[body]]
name = "whole"
kind = "shell"
shape = "sphere"
radius = 0.04
material = "ornament_glass"
thickness = 0.0005
position = [0, 0.0402, 0]
)";

/// Pieces and cracks of many seeds.
struct Pool {
  std::vector<double> masses;  // kg, without the largest of each run
  double least = 0.0;          // kg: ten triangles of the mesh
  double pieces = 0.0;         // mean
  double crossings = 0.0;      // mean number of cracks that cross a circle about the hit
  double seconds = 0.0;        // mean
};

/// Cracks of a break that cross the circle of `radius` m about the hit, in material space.
int cracks_across(const world::BreakRow& row, double radius) {
  int count = 0;
  for (const auto& ends : row.cracks) {
    const bool first = (ends[0] - row.place_material).norm() < radius,
               second = (ends[1] - row.place_material).norm() < radius;
    count += first != second ? 1 : 0;
  }
  return count;
}

Pool break_many(const char* text, const Vec3& velocity, int seeds, double after, double edge) {
  Pool pool;
  const char* moving = std::string(text).find("\"ball\"") != std::string::npos ? "ball" : "whole";
  for (int seed = 1; seed <= seeds; ++seed) {
    ScenePlay play(scene_of(
        text, {fmt::format("scene.seed={}", seed), fmt::format("whole.edge_length={}", edge),
               fmt::format("{}.velocity=[{}, {}, {}]", moving, velocity.x(), velocity.y(), velocity.z())}));
    for (const body::Body& body : play.world().bodies())
      if (body.name == "whole")
        pool.least = 10.0 * body.shape->mass / static_cast<double>(body.shape->surface.triangles.size());
    while (play.world().time() < 0.1 && play.world().report().breaks.empty()) play.step();
    play.play_until(play.world().time() + after);
    pool.seconds += play.seconds() / seeds;
    if (play.world().report().breaks.empty()) continue;
    pool.crossings += static_cast<double>(cracks_across(play.world().report().breaks[0], 0.15)) / seeds;
    std::vector<double> masses;
    for (const body::Body& body : play.world().bodies())
      if (play.world().ancestry(body.id).parent != 0) masses.push_back(body.shape->mass);
    pool.pieces += static_cast<double>(masses.size()) / seeds;
    std::sort(masses.begin(), masses.end());
    if (!masses.empty()) masses.pop_back();
    pool.masses.insert(pool.masses.end(), masses.begin(), masses.end());
  }
  return pool;
}

Measured fit_sizes(const char* text, const Vec3& velocity, int seeds, double edge, double low, double high) {
  const Pool pool = break_many(text, velocity, seeds, seeds > 1 ? 0.1 : 0.0, edge);
  const PowerLaw law = fit_power_law(pool.masses, pool.least);
  const double outside = std::max({0.0, low - law.exponent, law.exponent - high});
  return {
      {outside, law.exponent, law.half_width, static_cast<double>(law.count), pool.pieces}, pool.seconds, ""};
}

std::vector<std::string> conclude(const std::vector<Table>& tables) {
  std::vector<std::string> sentences;
  for (const Table& table : tables) {
    if (table.rows.empty()) continue;
    if (table.name == "radial") {
      std::vector<double> x, y;
      for (const Row& row : table.rows)
        if (row.errors[0] > 0.0) {
          x.push_back(std::log(row.value));
          y.push_back(std::log(row.errors[0]));
        }
      if (x.size() > 1) {
        const double slope = least_squares_slope(x, y);
        sentences.push_back(
            fmt::format("Cracks that cross a circle of 15 cm grow as V^{:.2f}; published is V^0.5 "
                        "(Vandenberghe, Vermorel and Villermaux 2013): {}.",
                        slope, std::abs(slope - 0.5) <= 0.15 ? "we agree within 0.15" : "we do not agree"));
      }
    }
    if (table.name == "sizes")
      for (const Row& row : table.rows)
        sentences.push_back(
            fmt::format("{}: exponent {:.2f} +- {:.2f} of {:.0f} pieces; {}.", row.setting, row.errors[1],
                        row.errors[2], row.errors[3],
                        row.errors[0] == 0.0 ? "within what is published" : "outside of what is published"));
  }
  return sentences;
}

Plan make_fragments_plan(bool is_quick) {
  Plan plan;
  Table sizes;
  sizes.name = "sizes";
  sizes.what =
      "masses of pieces, exponent of m^-tau above ten triangles, the largest of each run left out: shells "
      "1.1 to 1.6 "
      "(1.35, Wittel et al. 2004), plates 1.0 to 1.5 (1.17 where they bend, 1.5 in their plane, Linna et al. "
      "2005)";
  sizes.setting_name = "";
  sizes.error_names = {"outside of the published", "exponent", "half width, 95 %", "pieces fitted",
                       "pieces a run"};
  sizes.is_relative = false;
  sizes.is_plotted = false;
  const int seeds = is_quick ? 1 : 8;
  const double shell_edge = is_quick ? 0.006 : 0.003, pane_edge = is_quick ? 0.04 : 0.02;  // m
  const auto add = [&](const char* name, const char* text, const Vec3& velocity, double edge, double low,
                       double high) {
    plan.jobs.push_back(
        {0, name, kNoNumber, false, [=] { return fit_sizes(text, velocity, seeds, edge, low, high); }});
  };
  add("glass sphere, floor at 4 m/s", kShell, Vec3(0, -4, 0), shell_edge, 1.1, 1.6);
  if (!is_quick) add("glass sphere, floor at 8 m/s", kShell, Vec3(0, -8, 0), shell_edge, 1.1, 1.6);
  add("held pane, ball at 10 m/s", kHeldPaneText, Vec3(0, 0, -10), pane_edge, 1.0, 1.5);
  if (!is_quick) add("held pane, ball at 20 m/s", kHeldPaneText, Vec3(0, 0, -20), pane_edge, 1.0, 1.5);
  plan.tables.push_back(sizes);
  Table radial;
  radial.name = "radial";
  radial.what =
      "cracks of the first break of a held pane that cross a circle of 15 cm about the hit, means over flaw "
      "seeds";
  radial.setting_name = "m/s";
  radial.value_name = "speed, m/s";
  radial.order_name = "exponent";
  radial.error_names = {"cracks", "pieces"};
  radial.theory = {0.5};
  radial.is_relative = false;
  radial.is_plotted = false;
  for (const double speed :
       is_quick ? std::vector<double>{8, 16} : std::vector<double>{6, 8.5, 12, 17, 24, 34, 48})
    plan.jobs.push_back({1, fmt::format("{:g}", speed), speed, false, [speed, is_quick, pane_edge] {
                           const Pool pool = break_many(kHeldPaneText, Vec3(0, 0, -speed), is_quick ? 1 : 6,
                                                        0.0, pane_edge);
                           return Measured{{pool.crossings, pool.pieces}, pool.seconds, ""};
                         }});
  plan.tables.push_back(radial);
  plan.conclude = conclude;
  return plan;
}

}  // namespace
}  // namespace fragments

PowerLaw fit_power_law(const std::vector<double>& masses, double least) {
  PowerLaw law;
  double sum = 0.0;
  for (const double mass : masses)
    if (mass >= least) {
      sum += std::log(mass / least);
      ++law.count;
    }
  if (law.count < 2 || !(sum > 0.0)) return {kNoNumber, kNoNumber, law.count};
  law.exponent = 1.0 + law.count / sum;
  law.half_width = 1.96 * (law.exponent - 1.0) / std::sqrt(static_cast<double>(law.count));
  return law;
}

Study fragments_study() {
  return {"fragments", "sizes of pieces and counts of cracks over many seeds, beside published laws",
          fragments::make_fragments_plan};
}

}  // namespace shatterbox::sandbox::study
