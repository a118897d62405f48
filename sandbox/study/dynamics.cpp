#include "sandbox/study/dynamics.h"

#include <cmath>
#include <memory>
#include <stdexcept>

#include <fmt/format.h>

#include "engine/core/elementary.h"
#include "sandbox/study/explicit_motion.h"
#include "sandbox/study/stopwatch.h"
#include "sandbox/study/telling.h"

namespace shatterbox::sandbox::study {

namespace dynamics_parts {
namespace {

using namespace model;

/// A free beam that is hit, and its exact answers on its own mesh.
struct HitBeam {
  Beam beam;
  std::shared_ptr<const stress::SolidSystem> system;
  VecX impulse;
  double period = 0.0;  // s
  std::vector<stress::SolidStress> balanced;

  explicit HitBeam(int deep) : beam(0.2 / deep), system(make_solid_system(beam.stiffness, beam.mesh)) {
    impulse = beam.hit(0.2, Vec3(0.2, 0.0, -1.0));
    period = system->first_period();
    balanced = beam.stress_of(system->solve(impulse, fine()));
  }
  double first() const { return 2.0 * core::kPi / period; }  // rad/s
  double difference(const VecX& integral, const std::vector<stress::SolidStress>& exact) const {
    return stress_difference(beam.mesh, stress::cell_stresses(*beam.stiffness, beam.mesh, integral), exact);
  }
  /// The longest step that central differences bear, halved: of the stiffest motion, by Rayleigh's quotients
  /// of a residual that grows towards it.
  double stable_step() const {
    const VecX mass = stress::lumped_mass(*beam.stiffness, beam.mesh);
    VecX u = VecX::Zero(mass.size());
    for (Eigen::Index i = 0; i < u.size(); ++i) u(i) = static_cast<double>(i % 7) - 3.0;
    double square = 0.0;
    for (int i = 0; i < 60; ++i) {
      const VecX next = stress::apply_stiffness(*beam.stiffness, beam.mesh, u).cwiseQuotient(mass);
      square = next.norm() / u.norm();
      u = next / next.norm();
    }
    return 1.0 / std::sqrt(square);  // half of 2 / omega
  }
};

/// Waves damped by a tenth of critical of the first mode, for that many periods.
Measured wait_periods(const HitBeam& hit, double periods) {
  const double step = hit.stable_step();
  const Stopwatch watch;
  const VecX integral = integrate_motion(hit.beam, *hit.system, hit.impulse, 0.2 * hit.first(), 0.0,
                                         periods * hit.period, step);
  Measured measured;
  measured.seconds = watch.seconds();
  measured.errors = {hit.difference(integral, hit.balanced), periods * hit.period / step};
  return measured;
}

/// The balanced solve to the residual that a strength asks for.
Measured solve_balanced(const HitBeam& hit) {
  const Stopwatch watch;
  const auto system = make_solid_system(hit.beam.stiffness, hit.beam.mesh);
  const auto solution = system->solve(hit.impulse);
  Measured measured;
  measured.seconds = watch.seconds();
  measured.errors = {stress_difference(hit.beam.mesh, hit.beam.stress_of(solution), hit.balanced),
                     static_cast<double>(solution.iterations)};
  return measured;
}

/// The screened solve beside undamped waves seen through a window of 1 / s; and the balanced one beside the
/// same.
Measured look_through(const HitBeam& hit, double window) {
  const double s = hit.first() / window;
  const double step = std::min(hit.stable_step(), 1e-2 / s);
  const VecX seen = integrate_motion(hit.beam, *hit.system, hit.impulse, 0.0, s, 16.0 / s, step);
  const auto exact = stress::cell_stresses(*hit.beam.stiffness, hit.beam.mesh, seen);
  stress::SolidSolveSettings settings;
  settings.screening = s;
  const Stopwatch watch;
  const auto solution = hit.system->solve(hit.impulse, settings);
  Measured measured;
  measured.seconds = watch.seconds();
  if (!solution.is_evaluated()) throw std::runtime_error(solution.fault);
  measured.errors = {stress_difference(hit.beam.mesh, hit.beam.stress_of(solution), exact),
                     stress_difference(hit.beam.mesh, hit.balanced, exact)};
  return measured;
}

std::vector<std::string> conclude(const std::vector<Table>& tables) {
  std::vector<std::string> sentences;
  for (const Table& table : tables) {
    if (table.rows.empty() || table.name != "waves") continue;
    const Row& ours = table.rows.back();
    for (const Row& row : table.rows)
      if (!row.is_default && row.errors[0] <= ours.errors[0]) {
        sentences.push_back(
            fmt::format("The solve is right to {} in {}; the waves take {} steps, and {}, {:.0f} times as "
                        "long, to be as near.",
                        percent(ours.errors[0]), time_text(ours.seconds), std::lround(row.errors[1]),
                        time_text(row.seconds), row.seconds / ours.seconds));
        break;
      }
  }
  return sentences;
}

Plan make_dynamics_plan(bool is_quick) {
  Plan plan;
  const auto hit = std::make_shared<std::unique_ptr<HitBeam>>();
  const auto beam = [hit, deep = is_quick ? 2 : 4]() -> const HitBeam& {
    if (!*hit) *hit = std::make_unique<HitBeam>(deep);
    return **hit;
  };
  Table waves;
  waves.name = "waves";
  waves.what = "a free beam's damped waves, integrated over time, beside the balanced solve on the same mesh";
  waves.setting_name = "periods";
  waves.error_names = {"stress, L2", "steps, or iterations"};
  for (const double periods :
       is_quick ? std::vector<double>{1, 12} : std::vector<double>{1, 2, 4, 6, 8, 10, 12, 16})
    plan.jobs.push_back({0, fmt::format("waves over {:g}", periods), kNoNumber, false,
                         [beam, periods] { return wait_periods(beam(), periods); }});
  plan.jobs.push_back({0, "the solve: no", kNoNumber, true, [beam] { return solve_balanced(beam()); }});
  plan.tables.push_back(waves);
  Table window;
  window.name = "window";
  window.what = "the screened solve beside undamped waves seen through a window";
  window.setting_name = "of the first mode's 1 / omega";
  window.error_names = {"screened stress, L2", "balanced stress, L2"};
  for (const double length :
       is_quick ? std::vector<double>{3, 1} : std::vector<double>{30, 10, 3, 1, 0.3, 0.1})
    plan.jobs.push_back({1, fmt::format("{:g}", length), kNoNumber, length == 1.0,
                         [beam, length] { return look_through(beam(), length); }});
  plan.tables.push_back(window);
  plan.conclude = conclude;
  return plan;
}

}  // namespace
}  // namespace dynamics_parts

Study dynamics_study() {
  return {"dynamics", "stress by one solve beside the waves it stands for: error and cost",
          dynamics_parts::make_dynamics_plan};
}

}  // namespace shatterbox::sandbox::study
