#include "sandbox/study/fragments.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numeric>

#include <fmt/format.h>

#include "engine/geometry/mass_properties.h"
#include "engine/material/material.h"
#include "sandbox/study/order.h"
#include "sandbox/study/scene_play.h"
#include "sandbox/study/scene_texts.h"
#include "sandbox/study/shard_corners.h"
#include "sandbox/study/telling.h"
#include "sandbox/study/tempered.h"

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

// Of the root of a shard's area: how near to its outline lines must come. Cracks are wavy, arcs of rings
// round.
constexpr double kOutline = 0.05, kRoughOutline = 0.1;

/// Pieces and cracks of many seeds.
struct Pool {
  std::vector<double> masses;                  // kg, without the largest of each run
  std::vector<double> corners, rough_corners;  // of the pieces of at least `least`
  double least = 0.0;                          // kg: ten triangles of the mesh
  double pieces = 0.0;                         // mean
  double crossings = 0.0;                      // mean number of cracks that cross a circle about the hit
  double seconds = 0.0;                        // mean
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
    for (const body::Body& body : play.world().bodies()) {
      if (play.world().ancestry(body.id).parent == 0) continue;
      const body::Shape& shape = *body.shape;
      masses.push_back(shape.mass);
      if (shape.mass < pool.least) continue;
      const double size = std::sqrt(geometry::surface_area(shape.surface));
      pool.corners.push_back(count_corners(shape.surface, kOutline * size));
      pool.rough_corners.push_back(count_corners(shape.surface, kRoughOutline * size));
    }
    pool.pieces += static_cast<double>(masses.size()) / seeds;
    std::sort(masses.begin(), masses.end());
    if (!masses.empty()) masses.pop_back();
    pool.masses.insert(pool.masses.end(), masses.begin(), masses.end());
  }
  return pool;
}

/// The share of pieces heavier than each, of those that the law is fitted to, and the law: two curves.
void add_curves(const char* name, const Pool& pool, const PowerLaw& law, Figure& figure) {
  std::vector<double> sizes;
  for (const double mass : pool.masses)
    if (mass >= pool.least) sizes.push_back(mass / pool.least);
  if (sizes.size() < 2) return;
  std::sort(sizes.begin(), sizes.end());
  Figure::Curve found{name, {}, {}}, fitted{fmt::format("density m^-{:.2f}", law.exponent), {}, {}};
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    found.x.push_back(sizes[i]);
    found.y.push_back(static_cast<double>(sizes.size() - i) / static_cast<double>(sizes.size()));
  }
  for (const double size : {1.0, sizes.back()}) {
    fitted.x.push_back(size);
    fitted.y.push_back(std::pow(size, 1.0 - law.exponent));
  }
  figure.curves.push_back(found);
  figure.curves.push_back(fitted);
}

Measured fit_sizes(const char* name, const char* text, const Vec3& velocity, int seeds, double edge,
                   double low, double high, Figure& figure) {
  const Pool pool = break_many(text, velocity, seeds, seeds > 1 ? 0.1 : 0.0, edge);
  const PowerLaw law = fit_power_law(pool.masses, pool.least);
  add_curves(name, pool, law, figure);
  const double outside = std::max({0.0, low - law.exponent, law.exponent - high});
  return {{outside, law.exponent, law.half_width, static_cast<double>(law.count), pool.pieces, law.distance,
           law.usual_distance},
          pool.seconds,
          ""};
}

/// Mean corners of a flat shard: 4 is published for what breaks again and again along straight lines.
Measured mean_corners(const char* text, const Vec3& velocity, int seeds, double edge) {
  const Pool pool = break_many(text, velocity, seeds, 0.1, edge);
  const auto count = static_cast<double>(pool.corners.size());
  if (!(count > 1.0)) return {{kNoNumber, kNoNumber, kNoNumber, kNoNumber, count}, pool.seconds, ""};
  double sum = 0.0, squares = 0.0, rough = 0.0;
  for (const double corners : pool.corners) {
    sum += corners;
    squares += corners * corners;
  }
  for (const double corners : pool.rough_corners) rough += corners / count;
  const double mean = sum / count, variance = std::max(0.0, squares / count - mean * mean);
  return {{std::abs(mean - 4.0), mean, 1.96 * std::sqrt(variance / count), rough, count}, pool.seconds, ""};
}

// ---- breaking heights

// A hen's egg falls on steel. Its content is counted to the shell's mass.
const char* const kEgg = R"([scene]
after_break = "inherit"
[[body]]
name = "floor"
kind = "plane"
material = "steel"
[[body]]
name = "whole"
kind = "shell"
shape = "egg"
material = "eggshell"
thickness = 0.00035
edge_length = 0.0025
)";
constexpr double kEggMass = 0.06;  // kg

// A bronze ball of 100 g falls on the middle of a small glass plate in a frame.
const char* const kPlate = R"([scene]
after_break = "inherit"
[[material]]
name = "bronze"
like = "steel"
density = 8800
young = 1.1e11
[[body]]
name = "plate"
kind = "shell"
shape = "pane"
width = 0.158
height = 0.12
edge_length = 0.006
rotation = [-90, 0, 0]
material = "glass"
support = "edge"
[[body]]
name = "whole"
kind = "sphere"
radius = 0.01395
material = "bronze"
)";

/// What falls, and how high it must, m, by what is published.
struct Drop {
  const char* text;
  Overrides overrides;
  double low, high;  // m, that the published height lies between
};

/// The body `whole` of a scene, placed just above y = 0.
Overrides placed(const Drop& drop, double mass) {
  Overrides overrides = drop.overrides;
  overrides.push_back(fmt::format("whole.position=[0, {}, 0]", 1));
  ScenePlay play(scene_of(drop.text, overrides));
  double lowest = 1.0;
  for (const body::Body& body : play.world().bodies()) {
    if (body.name != "whole") continue;
    if (body.shape->kind == body::ShapeKind::sphere) lowest = 1.0 - body.shape->radius;
    for (const Vec3& p : body.shape->surface.positions) lowest = std::min(lowest, body.pose.apply(p).y());
    if (mass > 0.0) {
      const double density = material::find_preset("eggshell")->density;
      overrides.push_back(fmt::format("whole.density={}", density * mass / body.shape->mass));
    }
  }
  overrides.push_back(fmt::format("whole.position=[0, {}, 0]", 2.0e-4 + 1.0 - lowest));
  return overrides;
}

bool does_break(const Drop& drop, Overrides overrides, double height, int seed, double& seconds) {
  overrides.push_back(fmt::format("scene.seed={}", seed));
  overrides.push_back(fmt::format("whole.velocity=[0, {}, 0]", -std::sqrt(2.0 * 9.81 * height)));
  ScenePlay play(scene_of(drop.text, overrides));
  while (play.world().time() < 0.02 && play.world().report().breaks.empty()) play.step();
  seconds += play.seconds();
  return !play.world().report().breaks.empty();
}

/// The median over flaw seeds of the height from which it breaks.
Measured breaking_height(const Drop& drop, double mass, int seeds, int halvings) {
  const Overrides overrides = placed(drop, mass);
  std::vector<double> heights;
  double seconds = 0.0;
  for (int seed = 1; seed <= seeds; ++seed) {
    double held = 1e-3, broke = 10.0;  // m
    for (int i = 0; i < halvings; ++i) {
      const double height = std::sqrt(held * broke);
      (does_break(drop, overrides, height, seed, seconds) ? broke : held) = height;
    }
    heights.push_back(std::sqrt(held * broke));
  }
  std::sort(heights.begin(), heights.end());
  const double median = heights[heights.size() / 2];
  const double outside = std::max({0.0, median / drop.high - 1.0, drop.low / median - 1.0});
  return {
      {outside, 1e3 * median, 1e3 * heights.front(), 1e3 * heights.back(), 1e3 * drop.low, 1e3 * drop.high},
      seconds,
      ""};
}

std::string law_words(double distance, double usual) {
  if (distance <= usual)
    return fmt::format("a power law fits them, {:.2g} from it at most, as {:.2g} is usual", distance, usual);
  return fmt::format(
      "no power law fits them: they are up to {:.2g} from it, and 95 % of a power law's samples "
      "within {:.2g}",
      distance, usual);
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
        const auto part = fit_order(table, 0);
        const std::string on_a_line =
            part ? fmt::format(" (from {} to {} m/s as V^{:.2f})",
                               table.rows[static_cast<std::size_t>(part->rows.front())].setting,
                               table.rows[static_cast<std::size_t>(part->rows.back())].setting, part->order)
                 : "";
        sentences.push_back(fmt::format(
            "Over all speeds the cracks that cross a circle of 15 cm grow as V^{:.2f}{}; published "
            "is V^0.5 (Vandenberghe, Vermorel and Villermaux 2013): {}.",
            slope, on_a_line, std::abs(slope - 0.5) <= 0.15 ? "we agree within 0.15" : "we do not agree"));
      }
    }
    if (table.name == "corners")
      for (const Row& row : table.rows)
        sentences.push_back(
            fmt::format("{}: a shard has {:.2f} +- {:.2f} corners by lines within 5 % of its size, {:.2f} by "
                        "lines within 10 %; published is 4 (Domokos et "
                        "al. 2020): {}.",
                        row.setting, row.errors[1], row.errors[2], row.errors[3],
                        row.errors[0] <= 0.5 ? "we agree within 0.5" : "we do not agree"));
    if (table.name == "heights")
      for (const Row& row : table.rows)
        sentences.push_back(fmt::format(
            "{}: breaks from {:.3g} mm (median; {:.3g} to {:.3g} over flaw seeds), published is {}: {}.",
            row.setting, row.errors[1], row.errors[2], row.errors[3],
            row.errors[4] <= 0.0  ? fmt::format("below {:.3g} mm", row.errors[5])
            : row.errors[5] > 1e5 ? fmt::format("above {:.3g} mm", row.errors[4])
                                  : fmt::format("{:.3g} to {:.3g} mm", row.errors[4], row.errors[5]),
            row.errors[0] == 0.0  ? "we agree"
            : row.errors[0] < 1.0 ? "we do not agree, by less than a factor of two"
                                  : "we do not agree"));
    if (table.name == "sizes")
      for (const Row& row : table.rows) {
        sentences.push_back(
            fmt::format("{}: exponent {:.2f} +- {:.2f} of {:.0f} pieces; {}; {}.", row.setting, row.errors[1],
                        row.errors[2], row.errors[3],
                        row.errors[0] == 0.0 ? "within what is published" : "outside of what is published",
                        law_words(row.errors[5], row.errors[6])));
      }
    for (std::string& sentence : conclude_tempered(table)) sentences.push_back(std::move(sentence));
  }
  return sentences;
}

void add_corners(Plan& plan, bool is_quick) {
  Table table;
  table.name = "corners";
  table.what =
      "corners of the flat shards of a held pane, of at least ten triangles, by straight lines within 5 % of "
      "the root of a shard's area: 4 where cracks split what is left again and again (Domokos et al. 2020)";
  table.error_names = {"corners off 4", "corners", "half width, 95 %", "by lines within 10 %", "shards"};
  table.is_relative = false;
  table.is_plotted = false;
  for (const double speed : is_quick ? std::vector<double>{10} : std::vector<double>{10, 20})
    plan.jobs.push_back(
        {plan.tables.size(), fmt::format("ball at {:g} m/s", speed), kNoNumber, false, [speed, is_quick] {
           return mean_corners(kHeldPaneText, Vec3(0, 0, -speed), is_quick ? 1 : 8, is_quick ? 0.04 : 0.02);
         }});
  plan.tables.push_back(table);
}

void add_heights(Plan& plan, bool is_quick) {
  Table table;
  table.name = "heights";
  table.what =
      "height from which a thing breaks, median over flaw seeds, beside published drops: eggs on a hard "
      "floor, "
      "more than half broke on their ends from 8 mm, fewer than a tenth on their sides (Sutanto et al. "
      "2025); "
      "small plates of ordinary glass in a frame, under a bronze ball of 100 g (de la Bastie's trials, in "
      "Barff 1876)";
  table.error_names = {"beyond the published, share", "height, mm",      "least, mm", "greatest, mm",
                       "published from, mm",          "published to, mm"};
  table.is_relative = false;
  table.is_plotted = false;
  const int seeds = is_quick ? 1 : 9, halvings = is_quick ? 4 : 8;
  const auto add = [&](const char* name, const Drop& drop, double mass) {
    plan.jobs.push_back({plan.tables.size(), name, kNoNumber, false,
                         [=] { return breaking_height(drop, mass, seeds, halvings); }});
  };
  constexpr double kNoEnd = 1e3;  // m
  add("egg on its end", {kEgg, {}, 0.0, 0.008}, kEggMass);
  if (!is_quick) {
    add("egg on its side", {kEgg, Overrides(1, "whole.rotation=[0, 0, 90]"), 0.008, kNoEnd}, kEggMass);
    add("glass plate of 6 mm", {kPlate, Overrides(1, "plate.thickness=0.006"), 0.4, 0.5}, 0.0);
    add("glass plate of 4 mm", {kPlate, Overrides(1, "plate.thickness=0.004"), 0.3, 0.4}, 0.0);
  }
  plan.tables.push_back(table);
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
  sizes.error_names = {"outside of the published",
                       "exponent",
                       "half width, 95 %",
                       "pieces fitted",
                       "pieces a run",
                       "distance from the law",
                       "95 % of its samples are within"};
  sizes.is_relative = false;
  sizes.is_plotted = false;
  const int seeds = is_quick ? 1 : 8;
  const double shell_edge = is_quick ? 0.006 : 0.003, pane_edge = is_quick ? 0.04 : 0.02;  // m
  const auto figures = std::make_shared<std::map<std::string, Figure>>();  // by case: a job may run again
  const auto add = [&](const char* name, const char* text, const Vec3& velocity, double edge, double low,
                       double high) {
    plan.jobs.push_back({0, name, kNoNumber, false, [=] {
                           Figure& figure = (*figures)[name];
                           figure.curves.clear();
                           return fit_sizes(name, text, velocity, seeds, edge, low, high, figure);
                         }});
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
  add_corners(plan, is_quick);
  add_heights(plan, is_quick);
  add_tempered(plan, is_quick);
  plan.conclude = conclude;
  plan.draw = [figures](const std::vector<Table>&) {
    Figure all{"sizes",
               "shares of the pieces that are heavier, and the fitted densities",
               "mass, of ten triangles",
               "share of the pieces",
               true,
               true,
               {}};
    for (const auto& [name, figure] : *figures)
      all.curves.insert(all.curves.end(), figure.curves.begin(), figure.curves.end());
    return std::vector{all};
  };
  return plan;
}

}  // namespace
}  // namespace fragments

PowerLaw fit_power_law(const std::vector<double>& masses, double least) {
  PowerLaw law;
  std::vector<double> logs;  // of a power law they are an exponential's
  for (const double mass : masses)
    if (mass >= least) logs.push_back(std::log(mass / least));
  std::sort(logs.begin(), logs.end());
  const double sum = std::accumulate(logs.begin(), logs.end(), 0.0);
  law.count = static_cast<int>(logs.size());
  if (law.count < 2 || !(sum > 0.0)) return {kNoNumber, kNoNumber, law.count, kNoNumber, kNoNumber};
  const double count = law.count, root = std::sqrt(count);
  law.exponent = 1.0 + count / sum;
  law.half_width = 1.96 * (law.exponent - 1.0) / root;
  for (std::size_t i = 0; i < logs.size(); ++i) {
    const double heavier = std::exp(-(law.exponent - 1.0) * logs[i]), place = static_cast<double>(i);
    law.distance = std::max({law.distance, std::abs(1.0 - place / count - heavier),
                             std::abs(1.0 - (place + 1.0) / count - heavier)});
  }
  law.usual_distance = 1.094 / (root + 0.26 + 0.5 / root) + 0.2 / count;
  return law;
}

Study fragments_study() {
  return {"fragments", "sizes of pieces and counts of cracks over many seeds, beside published laws",
          fragments::make_fragments_plan};
}

}  // namespace shatterbox::sandbox::study
