#include "sandbox/study/scaling.h"

#include <algorithm>
#include <cmath>
#include <thread>

#include <fmt/format.h>

#include "engine/core/clock.h"
#include "engine/core/parallel.h"
#include "engine/material/tempering.h"
#include "sandbox/study/scene_play.h"
#include "sandbox/study/shell_models.h"
#include "sandbox/study/solid_models.h"
#include "sandbox/study/stopwatch.h"

namespace shatterbox::sandbox::study {

namespace scaling {
namespace {

using namespace model;

// Boats of 300 triangles poured onto a floor; none sleeps.
const char* const kBoats = R"([scene]
sleep = false
steps_per_second = 60
[[body]]
name = "floor"
kind = "plane"
material = "concrete"
[[body]]
name = "boats"
kind = "shell"
shape = "boat"
material = "plaster"
thickness = 0.004
breakable = false
position = [0, 0.6, 0]
rotation = [0, 0, 20]
)";

/// `count` boats in layers of `side` by `side`, five deep, in the second half of two seconds.
struct Pile {
  double cpu = 0.0, wall = 0.0;  // s a step
  double contacts = 0.0;         // mean
  long triangles = 0;
};

Pile pile(int count, int threads) {
  const int side = std::max(1, static_cast<int>(std::ceil(std::sqrt(count / 5.0))));
  ScenePlay play(
      scene_of(kBoats, {fmt::format("boats.repeat={{count={}, layer=[{}, {}], spacing=[1.1, 0.5, 0.6], "
                                    "jitter=0.03, rotation_jitter=20}}",
                                    count, side, side)}));
  core::set_thread_count(threads);
  play.play_until(1.0);
  Pile found;
  const Stopwatch watch;
  const auto start = core::Clock::now();
  const int steps = 60;
  for (int i = 0; i < steps; ++i) {
    play.step();
    found.contacts += static_cast<double>(play.world().report().contact.contacts) / steps;
  }
  found.cpu = watch.seconds() / steps;
  found.wall = core::milliseconds_since(start) / 1e3 / steps;
  core::set_thread_count(1);
  for (const body::Body& body : play.world().bodies())
    found.triangles += static_cast<long>(body.shape->surface.triangles.size());
  return found;
}

Measured count_bodies(int count) {
  const Pile found = pile(count, 1);
  return {{1e3 * found.cpu, found.contacts, 1e6 * found.cpu / std::max(1.0, found.contacts)}, found.cpu, ""};
}

/// A free pane of n by n cells: its factor, and one more solve.
Measured factor_pane(int n) {
  const auto elements = grid(n, n, 1.0, 1.0);
  const geometry::ShellMesh mesh = geometry::make_shell_mesh(elements);
  const auto stiffness = stress::make_shell_stiffness(elements, properties_of(0.01));
  VecX load = VecX::Zero(mesh.degree_of_freedom_count());
  load(stress::vertex_dof((n / 2) * (n + 1) + n / 2) + 2) = 1.0;
  const Stopwatch watch;
  const auto system = make_system(stiffness, mesh);
  const double factored = watch.seconds();
  const auto solution = system->solve(load);
  const double solved = watch.seconds() - factored;
  return {{1e3 * factored, 1e3 * solved, system->factor_entries(), solution.residual}, factored + solved, ""};
}

/// A free cube of about n^3 cells, hit in the middle of a side: its system, and one solve.
Measured solve_cube(int n) {
  const auto solids = lattice_box(Vec3(0.5, 0.5, 0.5), 1.0 / n);
  const geometry::SolidMesh mesh = make_solid_mesh(solids);
  const auto stiffness = make_solid_stiffness(solids, solid_properties(0.22));
  const auto skin = stress::make_border_skin(mesh);
  const VecX load = stress::patch_load(mesh, stress::find_load_patch(mesh, skin, Vec3(0.0, 0.5, 0.0), 0.15),
                                       Vec3(0.0, -1.0, 0.0));
  const Stopwatch watch;
  const auto system = make_solid_system(stiffness, mesh);
  const double made = watch.seconds();
  const auto solution = system->solve(load);
  const double solved = watch.seconds() - made;
  return {{1e3 * solved, 1e3 * made, static_cast<double>(solution.iterations)}, made + solved, ""};
}

Measured use_threads(int threads, int count) {
  const Pile found = pile(count, threads);
  return {{1e3 * found.wall, 1e3 * found.cpu}, found.wall, ""};
}

// Toughened glass goes to dice as a whole: as many pieces at once as there is pane.
const char* const kDicedPane = R"([[body]]
name = "whole"
kind = "shell"
shape = "pane"
edge_length = 0.01
thickness = 0.008
material = "tempered_glass"
[[body]]
name = "ball"
kind = "sphere"
radius = 0.01
material = "steel"
position = [0, 0, 0.012]
velocity = [0, 0, -50]
)";
constexpr int kStepsAfter = 4;

/// Of a pane `side` cm wide.
double count_dice(int side) {
  const material::Material glass = *material::find_preset("tempered_glass");
  return std::round(1e-4 * side * side / material::die_area(glass, 0.008));
}

Measured dice_pane(int side) {
  const double width = 0.01 * side;
  ScenePlay play(
      scene_of(kDicedPane, {fmt::format("whole.width={}", width), fmt::format("whole.height={}", width)}));
  double before = 0.0;
  while (play.world().time() < 0.1 && play.world().report().breaks.empty()) {
    before = play.seconds();
    play.step();
  }
  const double broken = play.seconds() - before;
  for (int i = 0; i < kStepsAfter; ++i) play.step();
  const double after = (play.seconds() - before - broken) / kStepsAfter;
  const auto pieces = static_cast<double>(play.world().bodies().size() - 1);
  return {{1e3 * after, 1e3 * broken, pieces}, play.seconds(), ""};
}

Table cost_table(const char* name, const char* what, const char* setting, std::vector<std::string> columns,
                 std::vector<double> theory) {
  Table table;
  table.name = name;
  table.what = what;
  table.setting_name = setting;
  table.value_name = "size";
  table.error_names = std::move(columns);
  table.theory = std::move(theory);
  table.is_relative = false;
  table.order_name = "exponent";
  table.is_plotted = false;
  return table;
}

void add_sizes(Plan& plan, Table table, const std::vector<int>& sizes,
               const std::function<double(int)>& size_of, const std::function<Measured(int)>& measure) {
  for (const int n : sizes)
    plan.jobs.push_back({plan.tables.size(), fmt::format("{:.0f}", size_of(n)), size_of(n), false,
                         [measure, n] { return measure(n); }});
  plan.tables.push_back(std::move(table));
}

/// Cost against size as a picture, of the tables that have one.
std::vector<Figure> draw_costs(const std::vector<Table>& tables) {
  Figure figure{"cost",
                "cost against size",
                "bodies, triangles, tetrahedra, dice",
                "ms a step, ms a factor or solve",
                true,
                true,
                {}};
  for (const Table& table : tables) {
    if (table.value_name.empty() || table.name == "threads") continue;
    Figure::Curve curve;
    curve.name = table.name + ": " + table.error_names[0];
    for (const Row& row : table.rows) {
      curve.x.push_back(row.value);
      curve.y.push_back(row.errors[0]);
    }
    figure.curves.push_back(std::move(curve));
  }
  return {figure};
}

Plan make_scaling_plan(bool is_quick) {
  Plan plan;
  add_sizes(
      plan,
      cost_table("bodies",
                 "boats of some 300 triangles in a pile five deep, a second after they were let fall, at "
                 "60 steps a second",
                 "boats", {"ms a step", "contacts", "us a contact"}, {1.0}),
      is_quick ? std::vector<int>{5, 10, 20} : std::vector<int>{10, 30, 100, 300, 1000},
      [](int n) { return n; }, count_bodies);
  add_sizes(
      plan,
      cost_table("pane", "factor of a free pane, by nested dissection", "triangles",
                 {"factor, ms", "solve, ms", "entries of the factor", "residual"}, {1.5, 1.0, 1.0}),
      is_quick ? std::vector<int>{16, 24, 32} : std::vector<int>{16, 32, 50, 70, 100},
      [](int n) { return 2.0 * n * n; }, factor_pane);
  add_sizes(
      plan,
      cost_table("cube", "solve of a free cube by conjugate gradients to 2e-3", "cells",
                 {"solve, ms", "system, ms", "iterations"}, {kNoNumber, 1.0}),
      is_quick ? std::vector<int>{4, 6, 8, 10} : std::vector<int>{6, 8, 12, 16, 20},
      [](int n) { return 1.0 * n * n * n; }, solve_cube);
  add_sizes(plan,
            cost_table(
                "pieces",
                "a pane of tempered glass breaks into dice at once: mean of the four steps after it, and the "
                "step in which it does, most of which is about the hit",
                "dice", {"a step after it, ms", "the break's step, ms", "pieces"}, {1.0}),
            is_quick ? std::vector<int>{6, 9, 14} : std::vector<int>{6, 9, 14, 20, 30}, count_dice,
            dice_pane);
  const std::string boats = fmt::format("{} boats, on a machine of {} processors that others may use too",
                                        is_quick ? 10 : 300, std::thread::hardware_concurrency());
  Table threads =
      cost_table("threads", boats.c_str(), "threads", {"ms a step on the clock", "ms of all processors"}, {});
  threads.value_name.clear();
  for (const int count : {1, 2, 4})
    plan.jobs.push_back({plan.tables.size(), std::to_string(count), static_cast<double>(count), count == 1,
                         [count, is_quick] { return use_threads(count, is_quick ? 10 : 300); }});
  plan.tables.push_back(std::move(threads));
  plan.draw = draw_costs;
  return plan;
}

}  // namespace
}  // namespace scaling

Study scaling_study() {
  return {"scaling",
          "cost against bodies, contacts, triangles, cells, pieces and threads, with fitted exponents",
          scaling::make_scaling_plan};
}

}  // namespace shatterbox::sandbox::study
