#include "sandbox/study/stress.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>

#include "sandbox/study/solid_models.h"
#include "sandbox/study/stopwatch.h"
#include "sandbox/study/stress_cases.h"
#include "sandbox/study/telling.h"

namespace shatterbox::sandbox::study {

namespace stress_study_parts {
namespace {

using namespace model;
using stress::SolidSolveSettings;

/// What the pins of [BHTF07] sec. V do to a load that is not in balance; and a picture of it.
struct Pins {
  std::vector<Figure::Curve> curves;  // greatest principal stress along the beam
};

/// Greatest first principal stress in each of 80 slices along the beam, Pa.
Figure::Curve along_beam(const char* name, const Beam& beam,
                         const std::vector<stress::SolidStress>& stresses) {
  Figure::Curve curve;
  curve.name = name;
  const int slices = 80;
  for (int i = 0; i < slices; ++i) curve.x.push_back(-1.0 + 2.0 * (i + 0.5) / slices);
  curve.y.assign(static_cast<std::size_t>(slices), 0.0);
  for (std::size_t c = 0; c < stresses.size(); ++c) {
    const double x = stress::cell_centroid(beam.mesh, beam.mesh.cells[c]).x();
    const auto slice =
        static_cast<std::size_t>(std::clamp(static_cast<int>((x + 1.0) / 2.0 * slices), 0, slices - 1));
    curve.y[slice] = std::max(curve.y[slice], stress::principal_axes(stresses[c]).values(0));
  }
  return curve;
}

double greatest(const std::vector<stress::SolidStress>& stresses) {
  double most = 0.0;
  for (const auto& stress : stresses) most = std::max(most, stress::principal_axes(stress).values(0));
  return most;
}

stress::SolidSolution solved(const stress::SolidSystem& system, const VecX& load, double tolerance) {
  auto solution = system.solve(load, fine(tolerance));
  if (!solution.is_evaluated()) throw std::runtime_error(solution.fault);
  return solution;
}

/// A free beam hit off its middle: the balanced load, and X1, X2, X3 at its first three vertices.
Measured pin_beam(int n, Pins& pins) {
  const Beam beam(0.2 / n);
  const VecX load = beam.hit(0.4, Vec3(0.3, -0.2, -1.0));
  const auto balanced = make_solid_system(beam.stiffness, beam.mesh);
  const auto true_stress = beam.stress_of(solved(*balanced, load, 1e-11));
  stress::SolidSystemOptions options;
  options.null_space = stress::NullSpace::paper;
  const Stopwatch watch;
  const auto paper = make_solid_system(beam.stiffness, beam.mesh, options);
  const auto false_stress = beam.stress_of(solved(*paper, load, 1e-11));
  Measured measured;
  measured.seconds = watch.seconds();
  const auto same_stress = beam.stress_of(solved(*paper, balanced->balance(load), 1e-11));
  measured.errors = {stress_difference(beam.mesh, false_stress, true_stress),
                     greatest(false_stress) / greatest(true_stress),
                     stress_difference(beam.mesh, same_stress, true_stress)};
  pins.curves = {along_beam("balanced load, any null space", beam, true_stress),
                 along_beam("the paper's X1 X2 X3, load as it is", beam, false_stress)};
  return measured;
}

/// The averaged stress of a tolerance beside that of a solve to 1e-12.
class SolverBeam {
 public:
  explicit SolverBeam(int deep) : beam_(0.2 / deep), load_(beam_.hit(0.4, Vec3(0.3, -0.2, -1.0))) {
    const auto system = make_solid_system(beam_.stiffness, beam_.mesh);
    exact_ = averaged(solved(*system, load_, 1e-12));
  }

  Measured solve_to(double tolerance) const {
    Measured measured;
    const Stopwatch watch;
    const auto system = make_solid_system(beam_.stiffness, beam_.mesh);
    SolidSolveSettings settings;
    settings.tolerance = tolerance;
    settings.most_iterations = 20000;
    const auto solution = system->solve(load_, settings);
    const auto found = averaged(solution);
    measured.seconds = watch.seconds();
    measured.errors = {stress_difference(beam_.mesh, found, exact_),
                       static_cast<double>(solution.iterations)};
    if (!solution.is_evaluated()) measured.note = solution.fault;
    return measured;
  }

 private:
  std::vector<stress::SolidStress> averaged(const stress::SolidSolution& solution) const {
    return stress::average_stresses(beam_.mesh, whole_contacts(beam_.mesh), beam_.stress_of(solution));
  }

  Beam beam_;
  VecX load_;
  std::vector<stress::SolidStress> exact_;
};

/// A closed form over element sizes. The usual size is that of bodies: shells of about 5000 triangles, solids
/// 16 cells a right angle or 4 across a thickness.
struct Case {
  Table table;
  std::vector<int> sizes;
  int usual = 0;  // 0: none
  std::function<StressCase(int)> solve;
  std::function<std::vector<double>(const StressCase&)> errors;
};

void add_case(Plan& plan, Case one, const char* setting) {
  one.table.setting_name = setting;
  one.table.value_name = "element size";
  one.table.error_names.insert(one.table.error_names.end(), {"elements", "iterations"});
  const auto measure = [solve = one.solve, errors = one.errors](int size) {
    const StressCase found = solve(size);
    Measured measured{errors(found), found.seconds, ""};
    measured.errors.push_back(static_cast<double>(found.elements));
    measured.errors.push_back(found.iterations > 0 ? found.iterations : kNoNumber);
    return measured;
  };
  for (const int size : one.sizes)
    plan.jobs.push_back({plan.tables.size(), std::to_string(size), 1.0 / size, size == one.usual,
                         [measure, size] { return measure(size); }});
  plan.tables.push_back(std::move(one.table));
}

std::vector<double> field_errors(const StressCase& found) {
  return {found.averaged, found.raw};
}

Table field_table(const char* name, const char* what) {
  Table table;
  table.name = name;
  table.what = what;
  table.error_names = {"averaged stress, L2", "elements' stress, L2"};
  table.theory = {kNoNumber, 1.0};
  return table;
}

void add_solids(Plan& plan, bool is_quick) {
  const SolidSolveSettings usual;
  const std::vector<int> sizes =
      is_quick ? std::vector<int>{6, 8, 12, 16} : std::vector<int>{8, 12, 16, 24, 32};
  add_case(plan,
           {field_table("sphere", "thick sphere under inner pressure, Lame"), sizes, 16,
            [usual](int n) { return thick_sphere(n, usual); }, field_errors},
           "cells a right angle");
  add_case(plan,
           {field_table("cylinder", "thick cylinder in plane strain under inner pressure, Lame"), sizes, 16,
            [usual](int n) { return thick_cylinder(n, usual); }, field_errors},
           "cells a quadrant");
  Table hole = field_table("hole", "plate with a hole under tension, Kirsch");
  hole.error_names.emplace_back("greatest stress");
  add_case(plan,
           {hole, sizes, 16, [usual](int n) { return plate_with_hole(n, usual); },
            [](const StressCase& c) {
              return std::vector<double>{c.averaged, c.raw, std::abs(c.concentration)};
            }},
           "cells a quadrant");
  Table disc = field_table("spin", "spinning disc, plane stress");
  disc.error_names.insert(disc.error_names.end(), {"centre", "rim"});
  add_case(plan,
           {disc, sizes, 16, [usual](int n) { return spinning_disc(n, usual); },
            [](const StressCase& c) {
              return std::vector<double>{c.averaged, c.raw, std::abs(c.concentration), std::abs(c.rim)};
            }},
           "cells across");
  const std::vector<int> depths =
      is_quick ? std::vector<int>{2, 3, 4, 6} : std::vector<int>{2, 3, 4, 6, 8, 12};
  Table deep = field_table("cantilever", "cantilever under an end force, M z / I in its middle half");
  deep.error_names.emplace_back("deflection (Timoshenko)");
  add_case(plan,
           {deep, depths, 4, [usual](int n) { return cantilever(n, 0.22, usual); },
            [](const StressCase& c) {
              return std::vector<double>{c.averaged, c.raw, std::abs(c.deflection - 1.0)};
            }},
           "elements deep");
  Table beam = field_table("beam", "free beam hit in the middle, M = J x^2 / 2 L");
  beam.error_names.emplace_back("greatest stress (J L / 8)");
  add_case(plan,
           {beam, depths, 4, [usual](int n) { return free_beam(n, usual); },
            [](const StressCase& c) {
              return std::vector<double>{c.averaged, c.raw, std::abs(c.concentration)};
            }},
           "elements deep");
}

Table shell_table(const char* name, const char* what, std::vector<std::string> errors,
                  std::vector<double> theory) {
  Table table;
  table.name = name;
  table.what = what;
  table.error_names = std::move(errors);
  table.theory = std::move(theory);
  return table;
}

void add_shells(Plan& plan, bool is_quick) {
  const std::vector<int> sizes =
      is_quick ? std::vector<int>{8, 16, 24, 32} : std::vector<int>{8, 16, 32, 50, 64};
  for (const bool is_clamped : {false, true})
    add_case(plan,
             {shell_table(is_clamped ? "plate-clamped" : "plate-hinged",
                          is_clamped ? "clamped square plate" : "simply supported square plate",
                          {"moment under pressure", "deflection under a force", "deflection under pressure"},
                          {2.0, 2.0, 2.0}),
              sizes, 50, [is_clamped](int n) { return square_plate(n, is_clamped); },
              [](const StressCase& c) {
                return std::vector<double>{c.raw, std::abs(c.deflection - 1.0), std::abs(c.rim)};
              }},
             "cells a side");
  add_case(plan,
           {shell_table("disc", "free disc hit in the middle, the relieved load's closed form",
                        {"averaged moments, L2", "elements' moments outside R / 4, L2", "deflection"},
                        {kNoNumber, 1.0, 2.0}),
            is_quick ? std::vector<int>{6, 8, 12, 16} : std::vector<int>{8, 16, 29, 40, 58}, 29, free_disc,
            [](const StressCase& c) {
              return std::vector<double>{c.averaged, c.rim, std::abs(c.deflection - 1.0)};
            }},
           "rings");
  // A level halves the elements: the size is 2^-level.
  const auto add_levels = [&](Table table, int usual, const std::function<StressCase(int)>& solve,
                              const std::function<std::vector<double>(const StressCase&)>& errors,
                              int finest) {
    std::vector<int> edges;
    for (int level = 2; level <= (is_quick ? 4 : finest); ++level) edges.push_back(1 << level);
    const auto level_of = [](int edges_a_side) {
      int level = 0;
      while (1 << level < edges_a_side) ++level;
      return level;
    };
    add_case(
        plan,
        {std::move(table), edges, usual, [solve, level_of](int e) { return solve(level_of(e)); }, errors},
        "edges to a side of the icosahedron");
  };
  add_levels(
      shell_table("balloon", "sphere under pressure, p R / 2 t", {"mean stress", "worst element"},
                  {2.0, kNoNumber}),
      16, pressed_sphere,
      [](const StressCase& c) {
        return std::vector<double>{c.raw, c.rim};
      },
      5);
  const auto pinch = [](const StressCase& c) {
    return std::vector<double>{std::abs(c.deflection - 1.0), c.concentration};
  };
  add_levels(
      shell_table("pinch", "sphere under two opposite forces, Reissner's deflection",
                  {"deflection", "greatest stress, Pa"}, {}),
      16, [](int level) { return pinched_sphere(level, true); }, pinch, 5);
  add_levels(
      shell_table("membrane", "the same sphere without bending, as the paper's shells are",
                  {"deflection", "greatest stress, Pa"}, {}),
      0, [](int level) { return pinched_sphere(level, false); }, pinch, 4);
}

void add_solver(Plan& plan, bool is_quick, const std::shared_ptr<Pins>& pins) {
  Table tolerance =
      shell_table("tolerance",
                  is_quick ? "free beam, 4 elements deep, hit off its middle: beside a solve to 1e-12"
                           : "free beam, 8 elements deep, hit off its middle: beside a solve to 1e-12",
                  {"averaged stress, L2", "iterations"}, {1.0});
  tolerance.setting_name = "residual";
  tolerance.value_name = "residual";
  const std::vector<double> residuals =
      is_quick ? std::vector<double>{3e-2, 1e-2, 2e-3, 1e-3, 1e-4}
               : std::vector<double>{1e-1, 3e-2, 1e-2, 2e-3, 1e-3, 1e-4, 1e-6, 1e-8};
  const auto beam = std::make_shared<std::optional<SolverBeam>>();  // made when it is first needed
  const auto measure = [beam, deep = is_quick ? 4 : 8](double residual) {
    if (!*beam) beam->emplace(deep);
    return (*beam)->solve_to(residual);
  };
  for (const double residual : residuals)
    plan.jobs.push_back({plan.tables.size(), fmt::format("{:g}", residual), residual,
                         residual == SolidSolveSettings{}.tolerance,
                         [measure, residual] { return measure(residual); }});
  plan.tables.push_back(std::move(tolerance));

  Table pinned = shell_table(
      "pins", "free beam hit off its middle: the paper's X1 X2 X3 on a load that is not in balance",
      {"elements' stress, L2", "greatest stress / true", "the same pins, balanced load, L2"}, {});
  pinned.setting_name = "elements deep";
  pinned.value_name = "element size";
  for (const int n : is_quick ? std::vector<int>{2, 4} : std::vector<int>{2, 4, 6, 8})
    plan.jobs.push_back(
        {plan.tables.size(), std::to_string(n), 1.0 / n, false, [n, pins] { return pin_beam(n, *pins); }});
  plan.tables.push_back(std::move(pinned));

  Table locking = shell_table(
      "locking",
      (is_quick ? "cantilever, 4 elements deep, against Poisson's ratio (above 0.4 it is solved with 0.4)"
                : "cantilever, 8 elements deep, against Poisson's ratio (above 0.4 it is solved with 0.4)"),
      {"averaged stress, L2", "elements' stress, L2", "deflection (Timoshenko)", "iterations"}, {});
  locking.setting_name = "Poisson's ratio";
  const int depth = is_quick ? 4 : 8;
  for (const double nu :
       is_quick ? std::vector<double>{0.22, 0.4} : std::vector<double>{0.0, 0.22, 0.3, 0.4, 0.45, 0.4999})
    plan.jobs.push_back({plan.tables.size(), fmt::format("{:g}", nu), kNoNumber, nu == 0.22, [nu, depth] {
                           const StressCase c = cantilever(depth, nu, SolidSolveSettings{});
                           return Measured{{c.averaged, c.raw, std::abs(c.deflection - 1.0),
                                            static_cast<double>(c.iterations)},
                                           c.seconds,
                                           ""};
                         }});
  plan.tables.push_back(std::move(locking));
}

std::vector<std::string> conclude(const std::vector<Table>& tables) {
  std::vector<std::string> sentences;
  for (const Table& table : tables) {
    if (table.rows.empty()) continue;
    const Row &first = table.rows.front(), &last = table.rows.back();
    if (table.name == "pins")
      sentences.push_back(
          fmt::format("A load that is not in balance, held at the paper's three points, has a stress that is "
                      "wrong by {} with {} "
                      "elements across and by {} with {}; its greatest is {:.1f} and {:.1f} times the true "
                      "one, at the pins. The "
                      "balanced load with the same pins agrees to {:.0e}.",
                      percent(first.errors[0]), first.setting, percent(last.errors[0]), last.setting,
                      first.errors[1], last.errors[1], std::max(first.errors[2], last.errors[2])));
    if (table.name == "membrane")
      sentences.push_back(
          fmt::format("Without bending the pinched sphere has no limit: its deflection is {:.2g} times "
                      "Reissner's with {} edges to a "
                      "side and {:.2g} times with {}, its greatest stress grows {:.2g} times.",
                      first.errors[0] + 1.0, first.setting, last.errors[0] + 1.0, last.setting,
                      last.errors[1] / first.errors[1]));
    if (table.name == "cantilever")
      sentences.push_back(
          fmt::format("One pass of averaging changes the cantilever's error from {} to {} with {} elements "
                      "across its depth, and from {} to {} with {}.",
                      percent(first.errors[1]), percent(first.errors[0]), first.setting,
                      percent(last.errors[1]), percent(last.errors[0]), last.setting));
  }
  return sentences;
}

Plan make_stress_plan(bool is_quick) {
  Plan plan;
  const auto pins = std::make_shared<Pins>();
  add_solids(plan, is_quick);
  add_shells(plan, is_quick);
  add_solver(plan, is_quick, pins);
  plan.conclude = conclude;
  plan.draw = [pins](const std::vector<Table>&) {
    return std::vector<Figure>{{"pins", "greatest principal stress along a free beam hit at x = 0.4", "x, m",
                                "stress, Pa (of 1 N)", false, true, pins->curves}};
  };
  return plan;
}

}  // namespace
}  // namespace stress_study_parts

Study stress_study() {
  return {"stress", "stress beside closed forms: element size, tolerance, averaging, null space",
          stress_study_parts::make_stress_plan};
}

}  // namespace shatterbox::sandbox::study
