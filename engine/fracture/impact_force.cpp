#include "engine/fracture/impact_force.h"

#include <algorithm>

#include "engine/core/clock.h"
#include "engine/core/elementary.h"
#include "engine/core/index.h"
#include "engine/core/parallel.h"
#include "engine/fracture/cell_flaws.h"
#include "engine/fracture/crack_course.h"
#include "engine/fracture/shell_subject.h"
#include "engine/material/tempering.h"
#include "engine/stress/contact_duration.h"
#include "engine/stress/loaded_parts.h"
#include "engine/stress/shell_load.h"
#include "engine/stress/stress_bound.h"

namespace shatterbox::fracture {
namespace {

using Size = std::size_t;
using core::at;

constexpr double kPatchElements = 1.5;  // least radius of a load's patch, in element sizes
// The same, as a share of the unbroken body's size: a mesh finer than that gives the same answer, crumbs
// included.
constexpr double kPatchShare = 0.075;
constexpr int kMostScreenings = 6;         // steps of the search for the duration
constexpr double kLargestResidual = 1e-4;  // of a solve that is an answer
constexpr double kPieceResidual = 3e-5;    // of what may be estimated
constexpr double kSpinThatCounts = 1e-3;   // least stress of a spin worth a solve, in strengths
constexpr double kSpinSafety = 4.0;        // by which a bound exceeds the estimate of the spin's stress
// Compliance of a thin plate at a corner over that far from its rim, about: the search for the duration
// begins below the screening that it ends at.
constexpr double kRimCompliance = 8.0;

using core::Clock;
using core::milliseconds_since;

/// Of a plate against bending, N m.
double plate_stiffness(const stress::ShellProperties& p) {
  return p.youngs_modulus * p.thickness * p.thickness * p.thickness /
         (12.0 * (1.0 - p.poisson_ratio * p.poisson_ratio));
}

/// Share of a load's energy that the cracks have left.
double energy_left(const Press& press, const Decision& decision) {
  return share_left(press.energy, decision.fracture_energy);
}

}  // namespace

ImpactForce::ImpactForce(const ShellSubject& subject, const ShellImpact& impact,
                         const FractureSettings& settings)
    : subject_(subject), impact_(impact), settings_(settings) {}

bool ImpactForce::prepare(std::string& problem) {
  if (!subject_.mesh || subject_.mesh->cells.empty()) {
    problem = "there is no material";
    return false;
  }
  const stress::ShellFigures& figures = subject_.systems->figures();
  const double least_radius =
      std::max({subject_.thickness, kPatchShare * figures.size, kPatchElements * figures.mean_edge_length});
  for (const ShellLoad& load : impact_.loads) {
    if (!(load.impulse > 0.0) && !(load.closing_speed > 0.0)) continue;
    if (!(load.direction.squaredNorm() > 0.5)) continue;
    Press press;
    press.load = &load;
    press.contact.point = load.point_material;
    press.contact.direction = load.direction;
    press.contact.hertz_compliance = std::max(0.0, load.hertz_compliance);
    press.contact.radius =
        settings_.patch_radius > 0.0 ? settings_.patch_radius : std::max(least_radius, load.hertz_radius);
    if (presses_.empty() || load.impulse > hardest().load->impulse) hardest_ = presses_.size();
    presses_.push_back(press);
  }
  if (presses_.empty()) problem = "no load";
  return !presses_.empty();
}

/// What bending by the spin comes to, about: 3/4 rho (spin size)^2 size / thickness.
double ImpactForce::spin_stress() const {
  const stress::ShellFigures& figures = subject_.systems->figures();
  const double size = std::min(figures.size, figures.reach);  // its own, not that of the body it came from
  const double rim_speed = impact_.spin_material.norm() * size;
  return 0.75 * subject_.material.density * rim_speed * rim_speed * size / subject_.thickness;
}

/// The least tension by loads that breaks a cell, Pa.
double ImpactForce::borne_by(Size cell) const {
  return weakest_strength(*subject_.flaws, *subject_.mesh, static_cast<int>(cell)) +
         subject_.material.surface_compression;
}

bool ImpactForce::is_spinning() const {
  return spin_stress() > kSpinThatCounts * material::borne_tension(subject_.material);
}

/// Whether the spin by itself might start a crack, or drive on the tip of one that rests.
bool ImpactForce::does_spin_crack() const {
  const double stress = kSpinSafety * spin_stress();
  const material::Material& m = subject_.material;
  const double toughness = core::sqrt(m.young * m.fracture_energy) * std::min(1.0, m.grain_strength);
  const double rest = kRestLength * subject_.thickness;
  if (!(stress * core::sqrt(0.5 * core::kPi * rest) < toughness)) return true;
  for (Size c = 0; c < subject_.mesh->cells.size(); ++c)
    if (!(stress < borne_by(c))) return true;
  return false;
}

std::optional<LoadBound::Worst> ImpactForce::harmless_bound() const {
  if (impact_.given_duration) return std::nullopt;
  if (are_snapshots(impact_)) return std::nullopt;  // a spring too deep holds more than there is
  const stress::ShellFigures& figures = subject_.systems->figures();
  const double width = std::max(subject_.thickness, settings_.least_width);
  const double spin = kSpinSafety * spin_stress();
  const double per_newton = stress::bending_bound(subject_.thickness, width, figures.reach, 1.0);
  const double per_root_joule = stress::stress_bound(properties_of(subject_), 1.0, 1.0);
  // Of two stresses von Mises' is at most sqrt(3) times the greater.
  const double flow = subject_.material.yield > 0.0 ? subject_.material.yield / core::sqrt(3.0) : 1e300;
  return LoadBound(impact_).harmless(
      figures.stressed_areas, [&](Size c) { return std::min(borne_by(c), flow); }, spin, per_newton,
      per_root_joule);
}

bool ImpactForce::use(const System& system, std::string& problem) {
  if (system)
    system_ = system.value();
  else
    problem = system.error();
  return static_cast<bool>(system);
}

bool ImpactForce::solve(const VecX& load, stress::ShellSolution& solution, std::string& problem) {
  solution = system_->solve(load, settings_.may_estimate ? kPieceResidual : kVerdictResidual);
  residual_ = std::max(residual_, solution.residual);
  if (solution.residual < kLargestResidual) return true;
  problem = "the solve did not reach its accuracy";
  return false;
}

/// The lead alone, with its displacement.
bool ImpactForce::answer_lead(Size lead, Decision& decision, std::string& problem) {
  const auto start = Clock::now();
  residual_ = 0.0;
  ContactAnswer answer;
  answer.load = share_load(*system_, groups_[lead]);
  const bool is_solved = solve(answer.load, lead_, problem);
  answer.compliance = lead_.compliance;
  answer.elastic_compliance = lead_.elastic_compliance;
  answers_ = {std::move(answer)};
  decision.solve_ms += milliseconds_since(start);
  return is_solved;
}

/// Resting contact presses as hard as it does however the body gives way: its compliance is asked for only
/// once the body cracks.
bool ImpactForce::can_wait(Size i) const {
  return !impact_.given_duration && !is_collision(*presses_[i].load) && groups_[i].forces.size() == 1;
}

/// The other loads that satisfy `is_wanted(i)` too, without their displacements.
template <class IsWanted>
void ImpactForce::answer(const IsWanted& is_wanted, Decision& decision) {
  const auto start = Clock::now();
  std::vector<Size> wanted;
  std::vector<PressGroups> groups;
  for (Size i = 0; i < groups_.size(); ++i) {
    if (!is_wanted(i)) continue;
    wanted.push_back(i);
    groups.push_back(groups_[i]);
  }
  std::vector<ContactAnswer> answers = press(*system_, groups, true);
  for (Size k = 0; k < wanted.size(); ++k) answers_[wanted[k]] = std::move(answers[k]);
  decision.solve_ms += milliseconds_since(start);
}

/// All loads, but for the lead where its answer is the only one there is.
void ImpactForce::answer_others(Size lead, Decision& decision) {
  std::vector<ContactAnswer> all(groups_.size());
  if (has_lead_) all[lead] = std::move(answers_.front());
  answers_ = std::move(all);
  for (Size i = 0; i < groups_.size(); ++i)
    if (can_wait(i)) answers_[i].load = groups_[i].forces.front();
  answer([&](Size i) { return !can_wait(i) && !(has_lead_ && i == lead); }, decision);
}

void ImpactForce::complete(Decision& decision) {
  answer([&](Size i) { return can_wait(i); }, decision);
  for (Size i = 0; i < presses_.size(); ++i) {
    Press& press = presses_[i];
    press.first_compliance = answers_[i].compliance;
    const double elastic =
        0.5 * press.force * press.force * (press.contact.hertz_compliance + answers_[i].elastic_compliance);
    if (press.energy == 0.0) press.energy = elastic;
    decision.elastic_energy += std::min(elastic, press.energy);
  }
}

/// The lead's displacement is that under all forces.
bool ImpactForce::is_alone() const {
  return presses_.size() == 1 && !is_spinning();
}

/// The displacement under all forces and the spin at once.
bool ImpactForce::solve_together(const geometry::ShellMesh& mesh, Decision& decision, std::string& problem) {
  const auto start = Clock::now();
  bool is_solved = true;
  if (!is_cracked_ && has_lead_ && is_alone()) {
    displacement_ = presses_.front().force * lead_.displacement;
  } else {
    VecX load = VecX::Zero(mesh.degree_of_freedom_count());
    for (Size i = 0; i < presses_.size(); ++i) load += presses_[i].force * answers_[i].load;
    if (is_spinning())
      load += stress::centrifugal_load(*subject_.systems->shared_stiffness(), mesh, impact_.spin_material,
                                       subject_.systems->figures().mass.centre);
    stress::ShellSolution solution;
    is_solved = solve(load, solution, problem);
    displacement_ = std::move(solution.displacement);
  }
  decision.solve_ms += milliseconds_since(start);
  return is_solved;
}

VecX ImpactForce::struck_displacement(Decision& decision) {
  const bool has_rest = std::any_of(presses_.begin(), presses_.end(),
                                    [](const Press& press) { return press.load->is_resting; });
  if (!has_rest && !is_spinning()) return displacement_;
  const auto start = Clock::now();
  VecX load = VecX::Zero(displacement_.size());
  for (Size i = 0; i < presses_.size(); ++i)
    if (!presses_[i].load->is_resting) load += presses_[i].force * answers_[i].load;
  stress::ShellSolution solution;
  std::string problem;
  if (load.isZero(0.0) || !solve(load, solution, problem)) return VecX::Zero(displacement_.size());
  decision.solve_ms += milliseconds_since(start);
  return std::move(solution.displacement);
}

DentEnergy ImpactForce::struck_energy() const {
  DentEnergy sum;
  for (Size i = 0; i < presses_.size(); ++i)
    add_energy(*presses_[i].load, presses_[i].force, answers_[i].elastic_compliance, sum);
  return sum;
}

/// A ball on a held body feels the body's inertia in its way; for free bodies it is in the effective mass.
double ImpactForce::felt_compliance(const ContactAnswer& answer) const {
  return subject_.clamped_vertices.empty() ? answer.elastic_compliance : answer.compliance;
}

double ImpactForce::duration_of(const Press& press, const ContactAnswer& answer) const {
  if (impact_.given_duration) return *impact_.given_duration;
  return stress::series_duration(press.load->effective_mass, press.contact.hertz_compliance,
                                 felt_compliance(answer));
}

/// The load whose duration counts: the hardest that has one.
std::optional<Size> ImpactForce::find_lead() const {
  std::optional<Size> lead;
  for (Size i = 0; i < presses_.size(); ++i) {
    if (!is_collision(*presses_[i].load) && !impact_.given_duration) continue;
    if (!lead || presses_[i].load->impulse > presses_[*lead].load->impulse) lead = i;
  }
  return lead;
}

/// Shorter than half the first period? The lead's own static displacement, as a trial motion, mostly settles
/// the matter.
bool ImpactForce::is_short() const {
  return duration_ < 0.5 * system_->trial_period(lead_) || system_->is_first_period_above(2.0 * duration_);
}

/// From an infinite plate, whose compliance under screening s is 1 / (8 s sqrt(D rho t)), half of it elastic,
/// times the effect of a rim.
double ImpactForce::guess_duration(const Press& lead, double rim) const {
  const stress::ShellProperties p = properties_of(subject_);
  const double a = core::kPi * core::kPi * lead.load->effective_mass * rim / 16.0 /
                   core::sqrt(plate_stiffness(p) * p.density * p.thickness);
  const double b = core::kPi * core::kPi * lead.load->effective_mass * lead.contact.hertz_compliance;
  return 0.5 * (a + core::sqrt(a * a + 4.0 * b));  // T^2 = a T + b
}

bool ImpactForce::screen(int exponent, Size lead, Decision& decision, std::string& problem) {
  const auto start = Clock::now();
  const System& screened = subject_.systems->screened(exponent);
  decision.factor_ms += milliseconds_since(start);
  if (!use(screened, problem) || !answer_lead(lead, decision, problem)) return false;
  duration_ = duration_of(presses_[lead], answers_.front());
  return true;
}

/// From a screening at or below the one that is sought to the nearest power of two to one over its own
/// duration. A higher screening never makes the duration longer, so the search from below ends at the lowest.
bool ImpactForce::climb(Size lead, Decision& decision, std::string& problem) {
  std::vector<int> tried;
  while (static_cast<int>(tried.size()) < kMostScreenings &&
         std::find(tried.begin(), tried.end(), exponent_) == tried.end()) {
    tried.push_back(exponent_);
    if (!screen(exponent_, lead, decision, problem)) return false;
    exponent_ = stress::quantise_screening(1.0 / duration_);
  }
  exponent_ = tried.back();
  return true;
}

/// The search from what the unscreened solve gave: it ends at the same screening wherever it begins.
bool ImpactForce::find_screening(Size lead, Decision& decision, std::string& problem) {
  const int lowest = stress::quantise_screening(1.0 / duration_);
  exponent_ = impact_.given_duration
                  ? lowest
                  : std::max(stress::quantise_screening(1.0 / guess_duration(presses_[lead], kRimCompliance)),
                             lowest);
  if (exponent_ > lowest) {
    if (!screen(exponent_, lead, decision, problem)) return false;
    const int next = stress::quantise_screening(1.0 / duration_);
    exponent_ = next > exponent_ ? next : lowest;  // else it began too high
  }
  return climb(lead, decision, problem);
}

/// An impact that is plainly short needs no unscreened solve: the search begins at the guess, and the
/// displacement it ends with, as a trial motion, shows that the first period is more than twice the duration.
/// False, and nothing is lost but time, if it began too high or the impact is not that short; then the
/// unscreened solve has to tell.
bool ImpactForce::is_plainly_short(Size lead, Decision& decision, std::string& problem) {
  if (impact_.given_duration) return false;
  const double guess = guess_duration(presses_[lead], kRimCompliance);
  const stress::ShellProperties p = properties_of(subject_);
  const geometry::MassProperties& mass = subject_.systems->figures().mass;
  // Of a slender free plate of the same moment of inertia, m l^2 / 12.
  const double length_squared = 12.0 * mass.inertia.trace() / (2.0 * mass.mass);
  const double plate_period =
      2.0 * core::kPi / 22.37 * length_squared * core::sqrt(p.density * p.thickness / plate_stiffness(p));
  if (guess > 0.5 * plate_period) return false;
  const int begin = exponent_ = stress::quantise_screening(1.0 / guess);
  if (!screen(begin, lead, decision, problem)) return false;
  const int next = stress::quantise_screening(1.0 / duration_);
  if (next < begin) return false;
  exponent_ = next;
  if (next > begin && !climb(lead, decision, problem)) return false;
  return duration_ < 0.5 * system_->trial_period(lead_);
}

/// Whether what the unscreened system answers is enough: most often it is pressed for longer than in the one
/// that is sought, and not as hard, but bends more. The duration is that of a hit far from all rims: nobody
/// knows it as long as no screening is sought, and hits must not be counted together for longer than they
/// are. The lead's displacement by itself is of no use among others.
bool ImpactForce::ends_search(Size lead, Decision& decision) {
  std::string problem;
  if (!is_enough_ || !use_unscreened(decision, problem)) return false;
  has_lead_ = is_alone();
  if (has_lead_ && !answer_lead(lead, decision, problem)) return false;
  answer_others(lead, decision);
  for (Size i = 0; i < presses_.size(); ++i) settle_force(presses_[i], answers_[i]);
  is_estimate_ = solve_together(*subject_.mesh, decision, problem) && is_enough_();
  if (is_estimate_)
    duration_ = std::min(duration_of(presses_[lead], answers_[lead]), guess_duration(presses_[lead], 1.0));
  return is_estimate_;
}

/// The lead's duration, in the system that it is long enough, or too short, for.
bool ImpactForce::settle_lead(Size lead, Decision& decision, std::string& problem) {
  if (ends_search(lead, decision)) return true;
  has_lead_ = true;
  is_screened_ = is_plainly_short(lead, decision, problem);
  if (is_screened_) return true;
  problem.clear();
  if (!use_unscreened(decision, problem) || !answer_lead(lead, decision, problem)) return false;
  duration_ = duration_of(presses_[lead], answers_.front());
  exponent_ = stress::quantise_screening(1.0 / duration_);
  is_screened_ = is_short();
  return !is_screened_ || find_screening(lead, decision, problem);
}

bool ImpactForce::use_unscreened(Decision& decision, std::string& problem) {
  const auto start = Clock::now();
  const System& unscreened = subject_.systems->unscreened();
  decision.factor_ms += milliseconds_since(start);
  return use(unscreened, problem);
}

void ImpactForce::find_groups(const geometry::ShellMesh& mesh,
                              const std::vector<geometry::CellContact>& contacts) {
  groups_.assign(presses_.size(), {});
  core::parallel_for(presses_.size(), 1,
                     [&](Size i) { groups_[i] = find_press_groups(mesh, contacts, presses_[i].contact); });
}

/// The mesh without the parts that no load is on: nothing cracks there, so they need no factor.
geometry::ShellMesh ImpactForce::pressed_parts(const geometry::ShellMesh& mesh) const {
  if (does_spin_crack()) return mesh;  // as it may where nothing else presses
  std::vector<const VecX*> forces;
  for (const PressGroups& groups : groups_)
    for (const VecX& force : groups.forces) forces.push_back(&force);
  return stress::loaded_parts(mesh, forces);
}

bool ImpactForce::settle(const IsEnough& is_enough, Decision& decision, std::string& problem) {
  const stress::ShellFigures& figures = subject_.systems->figures();
  core::parallel_for(2, 1, [&](Size part) {
    if (part == 0)
      subject_.systems->structure();  // made in the meantime
    else
      find_groups(*subject_.mesh, figures.contacts);
  });
  const int made_before = subject_.systems->count();
  duration_ = impact_.contact_average;
  is_enough_ = is_enough;
  const std::optional<Size> lead = find_lead();
  if (!(lead ? settle_lead(*lead, decision, problem) : use_unscreened(decision, problem))) return false;
  if (!is_estimate_) answer_others(lead.value_or(0), decision);
  decision.factorisations += subject_.systems->count() - made_before;
  if (is_estimate_) return true;
  for (Size i = 0; i < presses_.size(); ++i) settle_force(presses_[i], answers_[i]);
  return solve_together(*subject_.mesh, decision, problem);
}

void ImpactForce::settle_force(Press& press, const ContactAnswer& answer) {
  const ShellLoad& load = *press.load;
  const double compliance = press.contact.hertz_compliance + felt_compliance(answer);
  if (impact_.given_duration) {
    press.duration = *impact_.given_duration;
    press.first_force = stress::kPeakOverMeanHalfSine * load.impulse / press.duration;
  } else if (is_collision(load)) {
    press.duration = duration_of(press, answer);
    const double seen = stress::seen_over_peak(load.snapshots, press.duration);
    press.first_force = seen * collision_force(load, compliance);
    press.energy = seen * seen * collision_energy(load);
  } else {
    press.duration = impact_.contact_average;
    press.first_force = load.impulse / press.duration;
  }
  press.force = press.first_force;
}

/// Later generations are screened. Below the first frequency that adds the body's own inertia, as one rigid
/// whole.
void ImpactForce::prepare_cracked() {
  if (is_cracked_) return;
  is_cracked_ = true;
  if (!has_lead_) exponent_ = stress::quantise_screening(2.0 / system_->first_period());
  if (is_screened_ || !subject_.clamped_vertices.empty()) return;
  const double s = stress::screening_of(exponent_);
  for (Press& press : presses_)
    press.first_compliance += rigid_mobility(subject_.systems->figures().mass, *press.load) / (s * s);
}

bool ImpactForce::settle_again(const geometry::ShellMesh& mesh,
                               const std::vector<geometry::CellContact>& contacts, Decision& decision,
                               std::string& problem) {
  prepare_cracked();
  const auto start = Clock::now();
  find_groups(mesh, contacts);
  const System system =
      stress::ShellSystem::make(subject_.systems->shared_stiffness(), pressed_parts(mesh),
                                stress::screening_of(exponent_), support_of(subject_, mesh));
  decision.factor_ms += milliseconds_since(start);
  ++decision.factorisations;
  if (!use(system, problem)) return false;
  const auto solve_start = Clock::now();
  answers_ = press(*system_, groups_, false);
  residual_ = 0.0;
  const double s = system_->screening();
  for (Size i = 0; i < presses_.size(); ++i) {
    Press& press = presses_[i];
    const double hertz = press.contact.hertz_compliance;
    const double other = press.load->other_inverse_mass / (s * s);
    press.force = cracked_force(press.first_force, hertz, press.first_compliance, answers_[i].compliance,
                                other, energy_left(press, decision));
  }
  cap_forces(decision);
  decision.solve_ms += milliseconds_since(solve_start);
  return solve_together(mesh, decision, problem);
}

/// The springs cannot hold more than the energy that is left. An elastic compliance is at most the whole one,
/// so few have to be known.
void ImpactForce::cap_forces(const Decision& decision) {
  std::vector<Size> doubtful;
  std::vector<VecX> loads;
  const auto spring_energy = [&](const Press& press, double compliance) {
    return 0.5 * press.force * press.force * (press.contact.hertz_compliance + compliance);
  };
  for (Size i = 0; i < presses_.size(); ++i) {
    const Press& press = presses_[i];
    if (spring_energy(press, answers_[i].compliance) <= press.energy * energy_left(press, decision)) continue;
    doubtful.push_back(i);
    loads.push_back(answers_[i].load);
  }
  const std::vector<stress::LoadCompliance> compliances = system_->compliances(loads);
  for (Size k = 0; k < doubtful.size(); ++k) {
    Press& press = presses_[doubtful[k]];
    const double most = force_of_energy(press.energy * energy_left(press, decision),
                                        press.contact.hertz_compliance + compliances[k].elastic);
    press.force = std::min(press.force, most);
  }
}

}  // namespace shatterbox::fracture
