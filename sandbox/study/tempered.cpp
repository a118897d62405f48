#include "sandbox/study/tempered.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "engine/geometry/mass_properties.h"
#include "sandbox/study/order.h"
#include "sandbox/study/scene_play.h"

namespace shatterbox::sandbox::study {
namespace {

// A held pane is struck near the middle of its lower edge, as the standard's punch strikes it.
const char* const kTemperedPane = R"([scene]
gravity = [0, 0, 0]
[[material]]
name = "toughened"
like = "tempered_glass"
surface_compression = {}
[[body]]
name = "whole"
kind = "shell"
shape = "pane"
width = 0.3
height = 0.25
edge_length = 0.01
thickness = {}
material = "toughened"
support = "edge"
[[body]]
name = "ball"
kind = "sphere"
radius = 0.01
density = 240000
material = "steel"
position = [0, -0.105, 0.015]
velocity = [0, 0, -60]
)";

constexpr double kWindow = 0.05;                    // m, side of the square in which pieces are counted
constexpr double kFirstX = -0.125, kLastX = 0.075;  // m: 25 mm off the border
constexpr double kFirstY = 0.0, kLastY = 0.05;      // m: and more than 100 mm off the hit
constexpr double kAskedFor = 40.0;                  // EN 12150-1, 4 to 12 mm

/// 1 for a piece in the window, 1/2 for one that its border cuts.
double count_in_window(const std::vector<Vec3>& corners, double x, double y) {
  const auto is_inside = [&](const Vec3& p) {
    return p.x() > x && p.x() < x + kWindow && p.y() > y && p.y() < y + kWindow;
  };
  const auto inside = std::count_if(corners.begin(), corners.end(), is_inside);
  return inside == 0 ? 0.0 : inside == static_cast<std::ptrdiff_t>(corners.size()) ? 1.0 : 0.5;
}

struct Counts {
  double least = kNoNumber, mean = 0.0, most = 0.0;  // in a window
  double scatter = 0.0;                              // standard deviation of the areas over their mean
  double pieces = 0.0;
  double seconds = 0.0;
};

Counts count_dice(double thickness, double compression, int seeds) {
  Counts counts;
  std::vector<double> windows, areas;
  for (int seed = 1; seed <= seeds; ++seed) {
    ScenePlay play(scene_of(fmt::format(fmt::runtime(kTemperedPane), compression, thickness),
                            {fmt::format("scene.seed={}", seed)}));
    while (play.world().time() < 0.1 && play.world().report().breaks.empty()) play.step();
    counts.seconds += play.seconds() / seeds;
    std::vector<std::vector<Vec3>> pieces;
    for (const body::Body& body : play.world().bodies()) {
      if (play.world().ancestry(body.id).parent == 0) continue;
      pieces.push_back(body.shape->surface.positions);
      for (Vec3& p : pieces.back()) p += body.shape->material_from_body;
      areas.push_back(geometry::surface_area(body.shape->surface));
    }
    counts.pieces += static_cast<double>(pieces.size()) / seeds;
    for (double x = kFirstX; x < kLastX + 0.5 * kWindow; x += kWindow)
      for (double y = kFirstY; y < kLastY + 0.5 * kWindow; y += kWindow) {
        double count = 0.0;
        for (const auto& corners : pieces) count += count_in_window(corners, x, y);
        windows.push_back(count);
      }
  }
  counts.least = *std::min_element(windows.begin(), windows.end());
  counts.most = *std::max_element(windows.begin(), windows.end());
  for (const double count : windows) counts.mean += count / static_cast<double>(windows.size());
  double sum = 0.0, squares = 0.0;
  for (const double area : areas) {
    sum += area;
    squares += area * area;
  }
  const double n = static_cast<double>(areas.size());
  if (n > 1.0) counts.scatter = std::sqrt(std::max(0.0, squares * n / (sum * sum) - 1.0));
  return counts;
}

Measured measure_dice(double thickness, double compression, int seeds) {
  const Counts counts = count_dice(thickness, compression, seeds);
  return {{std::max(0.0, 1.0 - counts.least / kAskedFor), counts.least, counts.mean, counts.most,
           counts.scatter, counts.pieces},
          counts.seconds,
          ""};
}

Table dice_table(const char* name, const std::string& what) {
  Table table;
  table.name = name;
  table.what = what;
  table.error_names = {
      "below the standard, share", "least in 50 x 50 mm", "mean", "most", "scatter of areas", "pieces"};
  table.is_relative = false;
  table.is_plotted = false;
  return table;
}

}  // namespace

void add_tempered(Plan& plan, bool is_quick) {
  const int seeds = is_quick ? 1 : 3;
  Table thicknesses = dice_table(
      "tempered",
      "a pane of tempered glass (100 MPa of compression at its faces) is struck near an edge: pieces in "
      "squares of 50 mm, 25 mm off the border and 100 mm off the hit; EN 12150-1 asks for 40 of glass 4 to "
      "12 "
      "mm thick");
  thicknesses.setting_name = "mm thick";
  for (const double thickness : is_quick ? std::vector<double>{6} : std::vector<double>{4, 5, 6, 8, 10, 12})
    plan.jobs.push_back({plan.tables.size(), fmt::format("{:g}", thickness), kNoNumber, thickness == 6,
                         [=] { return measure_dice(1e-3 * thickness, 100e6, seeds); }});
  plan.tables.push_back(thicknesses);
  if (is_quick) return;
  Table stresses = dice_table("tempered-stress",
                              "the same, 6 mm thick, over the compression at its faces: heat-strengthened "
                              "glass has 24 to 52 MPa, fully tempered glass 69 and more (ASTM C1048)");
  stresses.setting_name = "MPa";
  stresses.value_name = "compression at the faces, MPa";
  stresses.order_name = "exponent";
  for (const double compression : {40.0, 60.0, 80.0, 90.0, 100.0, 110.0, 130.0})
    plan.jobs.push_back({plan.tables.size(), fmt::format("{:g}", compression), kNoNumber, compression == 100,
                         [=] { return measure_dice(6e-3, 1e6 * compression, seeds); }});
  plan.tables.push_back(stresses);
}

std::vector<std::string> conclude_tempered(const Table& table) {
  std::vector<std::string> sentences;
  if (table.name != "tempered" && table.name != "tempered-stress") return sentences;
  const char* unit = table.name == "tempered" ? "mm of tempered glass" : "MPa in 6 mm of glass";
  for (const Row& row : table.rows)
    sentences.push_back(fmt::format(
        "{} {}: {:g} pieces in the poorest square of 50 mm, {:.3g} in the mean; {}.", row.setting, unit,
        row.errors[1], row.errors[2],
        row.errors[0] > 0.0 ? "fewer than the 40 of EN 12150-1" : "the 40 of EN 12150-1 are there"));
  if (const auto row = default_row(table); row && table.name == "tempered")
    sentences.push_back(
        fmt::format("The areas of the dice, those of the hit and of the border with them, scatter by {:.2g} "
                    "of their mean; by 1 "
                    "if their sizes follow an exponential law, as published for toughened glass (Dawara and "
                    "Viswanathan 2026): {}.",
                    table.rows[*row].errors[4],
                    table.rows[*row].errors[4] < 0.8 ? "ours are more even" : "we agree within a fifth"));
  return sentences;
}

}  // namespace shatterbox::sandbox::study
