#include "engine/fracture/solid_force.h"

#include <algorithm>
#include <numeric>

#include "engine/core/clock.h"
#include "engine/core/index.h"
#include "engine/stress/contact_duration.h"
#include "engine/stress/shell_system_cache.h"
#include "engine/stress/stress_bound.h"

namespace shatterbox::fracture {
namespace {

using Size = std::size_t;
using core::at;

// As for shells (impact_force.cpp).
constexpr double kSolidPatchElements = 1.5;    // least radius of a load's patch, in element sizes
constexpr double kSolidPatchShare = 0.15;      // and as a share of the body's width
constexpr Size kMostSolidGroups = 8;           // pieces that share one load: each costs a solve
constexpr int kMostSolidScreenings = 6;        // steps of the search for the duration
constexpr double kSolidSpinThatCounts = 1e-3;  // least stress of a spin worth a solve, in strengths
constexpr double kSolidSpinSafety = 4.0;       // by which a bound exceeds the estimate of the spin's stress

PressGroups find_solid_groups(const geometry::SolidMesh& mesh, const stress::SolidSkin& skin,
                              const ContactPress& load) {
  const stress::SolidPatch patch = stress::find_load_patch(mesh, skin, load.point, load.radius);
  const std::vector<int> group_of_share = stress::group_patch(mesh, patch);
  const int count =
      group_of_share.empty() ? 0 : *std::max_element(group_of_share.begin(), group_of_share.end()) + 1;
  std::vector<double> weight(at(count));
  for (int g = 0; g < count; ++g) weight[at(g)] = stress::group_weight(patch, group_of_share, g);
  PressGroups groups;
  groups.hertz_compliance = load.hertz_compliance;
  for (const int g : heaviest_groups(weight, kMostSolidGroups)) {
    groups.weights.push_back(weight[at(g)]);
    groups.forces.push_back(stress::group_load(mesh, patch, group_of_share, g, load.direction));
  }
  return groups;
}

}  // namespace

SolidForce::SolidForce(const SolidSubject& subject, const Impact& impact, const FractureSettings& settings)
    : subject_(subject), impact_(impact), settings_(settings) {}

bool SolidForce::prepare(std::string& problem) {
  if (!subject_.model || subject_.model->mesh.cells.empty()) {
    problem = "there is no material";
    return false;
  }
  const SolidModel& model = *subject_.model;
  if (!model.system) {
    problem = model.fault;
    return false;
  }
  mesh_ = &model.mesh;
  skin_ = &model.skin;
  system_ = model.system;
  const double least_radius =
      std::max(kSolidPatchShare * model.width, kSolidPatchElements * model.mean_edge_length);
  for (const ImpactLoad& load : impact_.loads) {
    if (!(load.impulse > 0.0) && !(load.closing_speed > 0.0)) continue;
    if (!(load.direction.squaredNorm() > 0.5)) continue;
    SolidPress press;
    press.load = &load;
    press.contact.point = load.point_material;
    press.contact.direction = load.direction;
    press.contact.hertz_compliance = std::max(0.0, load.hertz_compliance);
    press.contact.radius =
        settings_.patch_radius > 0.0 ? settings_.patch_radius : std::max(least_radius, load.hertz_radius);
    if (presses_.empty() || load.impulse > hardest().load->impulse) hardest_ = presses_.size();
    presses_.push_back(std::move(press));
  }
  if (presses_.empty()) problem = "no load";
  return !presses_.empty();
}

/// About: rho (spin size)^2 over 3 is a disc's or a rod's; bending by the spin of a bent bar is more.
double SolidForce::spin_stress() const {
  const SolidModel& model = *subject_.model;
  const double rim_speed = impact_.spin_material.norm() * model.reach;
  return 0.5 * subject_.material.density * rim_speed * rim_speed *
         std::max(1.0, model.reach / std::max(4.0 * model.width, 1e-300));
}

bool SolidForce::is_spinning() const {
  return spin_stress() > kSolidSpinThatCounts * subject_.material.strength;
}

std::optional<SolidForce::Bound> SolidForce::harmless_bound() const {
  if (impact_.given_duration) return std::nullopt;
  if (are_snapshots(impact_)) return std::nullopt;  // a spring too deep holds more than there is
  // Loads add up: so do the roots of collisions' energies, and the forces of resting contact.
  double root_energy = 0.0, contact_force = 0.0;
  for (const SolidPress& press : presses_) {
    const ImpactLoad& load = *press.load;
    if (is_collision(load))
      root_energy += core::sqrt(collision_energy(load));
    else
      contact_force += load.impulse / impact_.contact_average;
  }
  const SolidModel& model = *subject_.model;
  if (!(model.width > 0.0)) return std::nullopt;
  const double constant = kSolidSpinSafety * spin_stress() +
                          stress::bending_bound(model.width, model.width, model.reach, contact_force);
  const double per_root_volume = stress::stress_bound(*model.stiffness, 1.0, root_energy * root_energy);
  // Of two stresses von Mises' is at most sqrt(3) times the greater.
  const double flow = subject_.material.yield > 0.0 ? subject_.material.yield / core::sqrt(3.0) : 1e300;
  Bound worst;
  for (Size c = 0; c < model.mesh.cells.size(); ++c) {
    const double volume = model.stressed_volumes[c];
    if (!(volume > 0.0)) return std::nullopt;
    double strength = subject_.flaws->greatest_strength;
    // The weakest is the first; whether it lies in this cell of its element does not matter to a bound.
    if (const auto flaws = subject_.flaws->of_element(model.mesh.cells[c].element); !flaws.empty())
      strength = std::min(strength, flaws.front().strength);
    strength = std::min(strength, flow);
    const double stress = per_root_volume / core::sqrt(volume) + constant;
    if (!(stress < strength)) return std::nullopt;
    if (stress * worst.strength >= worst.stress * strength) worst = {stress, strength};
  }
  return worst;
}

void SolidForce::find_groups() {
  groups_.clear();
  for (const SolidPress& press : presses_)
    groups_.push_back(find_solid_groups(*mesh_, *skin_, press.contact));
}

bool SolidForce::note(const stress::SolidSolution& solution, SolidDecision& decision,
                      std::string& problem) const {
  decision.residual = std::max(decision.residual, solution.residual);
  decision.iterations += solution.iterations;
  if (!solution.is_evaluated()) problem = solution.fault;
  return solution.is_evaluated();
}

/// What a unit force of each of these loads meets, as the pieces under it share it.
bool SolidForce::answer(const std::vector<Size>& wanted, SolidDecision& decision, std::string& problem) {
  const auto start = core::Clock::now();
  std::vector<VecX> forces;
  for (const Size i : wanted) forces.insert(forces.end(), groups_[i].forces.begin(), groups_[i].forces.end());
  stress::SolidSolveSettings solving;
  solving.screening = screening_;
  solving.tolerance = settings_.solve_residual;
  const std::vector<stress::SolidSolution> all = system_->solve(forces, solving);
  decision.solve_ms += core::milliseconds_since(start);
  auto next = all.begin();
  for (const Size i : wanted) {
    SolidPress& press = presses_[i];
    const PressGroups& groups = groups_[i];
    const std::vector<stress::SolidSolution> own(next,
                                                 next + static_cast<std::ptrdiff_t>(groups.forces.size()));
    next += static_cast<std::ptrdiff_t>(groups.forces.size());
    for (const stress::SolidSolution& solution : own)
      if (!note(solution, decision, problem)) return false;
    const Eigen::MatrixXd flexibility = stress::compliance_matrix(groups.forces, own);
    const Eigen::VectorXd shares = share_force(groups, flexibility);
    press.displacement = VecX::Zero(system_->dof_count());
    for (Eigen::Index g = 0; g < shares.size(); ++g)
      if (shares[g] != 0.0) press.displacement += shares[g] * own[static_cast<Size>(g)].displacement;
    press.compliance = shares.dot(flexibility * shares);
    press.elastic_compliance =
        own.size() == 1
            ? own.front().elastic_compliance
            : press.displacement.dot(apply_stiffness(*subject_.model->stiffness, *mesh_, press.displacement));
  }
  return true;
}

/// A ball on a held body feels the body's inertia in its way; for free bodies it is in the effective mass.
double SolidForce::felt_compliance(const SolidPress& press) const {
  return subject_.clamped_vertices.empty() ? press.elastic_compliance : press.compliance;
}

double SolidForce::duration_of(const SolidPress& press) const {
  if (impact_.given_duration) return *impact_.given_duration;
  return stress::series_duration(press.load->effective_mass, press.contact.hertz_compliance,
                                 felt_compliance(press));
}

/// The lead's duration, in the system that it is long enough, or too short, for. Departs from shells: the
/// period that counts is that of the motion which this load excites (Rayleigh's quotient of its static
/// displacement), not the body's first one, which may be of a motion that it does not; and costs nothing.
bool SolidForce::settle_lead(Size lead, SolidDecision& decision, std::string& problem) {
  has_lead_ = true;
  if (!answer({lead}, decision, problem)) return false;
  duration_ = duration_of(presses_[lead]);
  stress::SolidSolution motion;
  motion.displacement = presses_[lead].displacement;
  motion.elastic_compliance = presses_[lead].elastic_compliance;
  exponent_ = stress::quantise_screening(1.0 / duration_);
  if (!(duration_ < 0.5 * system_->trial_period(motion))) return true;
  // A higher screening never makes the duration longer: the search climbs.
  std::vector<int> tried;
  while (static_cast<int>(tried.size()) < kMostSolidScreenings &&
         std::find(tried.begin(), tried.end(), exponent_) == tried.end()) {
    tried.push_back(exponent_);
    screening_ = stress::screening_of(exponent_);
    if (!answer({lead}, decision, problem)) return false;
    duration_ = duration_of(presses_[lead]);
    exponent_ = stress::quantise_screening(1.0 / duration_);
  }
  exponent_ = tried.back();
  return true;
}

bool SolidForce::settle(SolidDecision& decision, std::string& problem) {
  find_groups();
  duration_ = impact_.contact_average;
  std::optional<Size> lead;
  for (Size i = 0; i < presses_.size(); ++i) {
    if (!is_collision(*presses_[i].load) && !impact_.given_duration) continue;
    if (!lead || presses_[i].load->impulse > presses_[*lead].load->impulse) lead = i;
  }
  if (lead && !settle_lead(*lead, decision, problem)) return false;
  std::vector<Size> others;
  for (Size i = 0; i < presses_.size(); ++i)
    if (i != lead) others.push_back(i);
  if (!others.empty() && !answer(others, decision, problem)) return false;
  for (SolidPress& press : presses_) settle_force(press);
  return sum_up(decision, problem);
}

void SolidForce::settle_force(SolidPress& press) {
  const ImpactLoad& load = *press.load;
  if (impact_.given_duration) {
    press.duration = *impact_.given_duration;
    press.first_force = stress::kPeakOverMeanHalfSine * load.impulse / press.duration;
  } else if (is_collision(load)) {
    press.duration = duration_of(press);
    const double seen = stress::seen_over_peak(load.snapshots, press.duration);
    press.first_force = seen * collision_force(load, press.contact.hertz_compliance + felt_compliance(press));
    press.energy = seen * seen * collision_energy(load);
  } else {
    press.duration = impact_.contact_average;
    press.first_force = load.impulse / press.duration;
  }
  press.force = press.first_force;
}

VecX SolidForce::struck_displacement() const {
  VecX sum = VecX::Zero(system_->dof_count());
  for (const SolidPress& press : presses_)
    if (!press.load->is_resting) sum += press.force * press.displacement;
  return sum;
}

namespace {

double energy_of(const SolidPress& press) {
  if (press.load->is_resting) return 0.0;
  return is_collision(*press.load) ? collision_energy(*press.load)
                                   : 0.5 * press.force * press.force * press.elastic_compliance;
}

}  // namespace

double SolidForce::struck_energy() const {
  double sum = 0.0;
  for (const SolidPress& press : presses_) sum += energy_of(press);
  return sum;
}

double SolidForce::lost_energy() const {
  double sum = 0.0;
  for (const SolidPress& press : presses_)
    sum += (1.0 - press.load->restitution * press.load->restitution) * energy_of(press);
  return sum;
}

void SolidForce::complete(SolidDecision& decision) {
  for (SolidPress& press : presses_) {
    press.first_compliance = press.compliance;
    const double elastic =
        0.5 * press.force * press.force * (press.contact.hertz_compliance + press.elastic_compliance);
    if (press.energy == 0.0) press.energy = elastic;
    decision.elastic_energy += std::min(elastic, press.energy);
  }
}

/// Later generations are screened. Below the first frequency that adds the body's own inertia, as one rigid
/// whole.
void SolidForce::prepare_cracked() {
  if (is_cracked_) return;
  is_cracked_ = true;
  if (!has_lead_) exponent_ = stress::quantise_screening(2.0 / system_->first_period());
  const bool was_screened = screening_ > 0.0;
  screening_ = stress::screening_of(exponent_);
  if (was_screened || !subject_.clamped_vertices.empty()) return;
  for (SolidPress& press : presses_)
    press.first_compliance += rigid_mobility(subject_.model->mass, *press.load) / (screening_ * screening_);
}

bool SolidForce::settle_again(const geometry::SolidMesh& mesh, const stress::SolidSkin& skin,
                              SolidDecision& decision, std::string& problem) {
  prepare_cracked();
  mesh_ = &mesh;
  skin_ = &skin;
  find_groups();
  const auto start = core::Clock::now();
  stress::SolidSystemOptions options;
  options.support = support_of(mesh, subject_.clamped_vertices);
  const auto system = stress::SolidSystem::make(subject_.model->stiffness, mesh, options);
  decision.solve_ms += core::milliseconds_since(start);
  if (!system) {
    problem = system.error();
    return false;
  }
  system_ = system.value();
  std::vector<Size> all(presses_.size());
  std::iota(all.begin(), all.end(), Size{0});
  if (!answer(all, decision, problem)) return false;
  for (SolidPress& press : presses_) {
    const double hertz = press.contact.hertz_compliance;
    const double other = press.load->other_inverse_mass / (screening_ * screening_);
    const double left = share_left(press.energy, decision.fracture_energy);
    press.force =
        cracked_force(press.first_force, hertz, press.first_compliance, press.compliance, other, left);
    // The springs cannot hold more than the energy that is left.
    press.force =
        std::min(press.force, force_of_energy(press.energy * left, hertz + press.elastic_compliance));
  }
  return sum_up(decision, problem);
}

/// The displacement under all forces and the spin at once: the answer is linear.
bool SolidForce::sum_up(SolidDecision& decision, std::string& problem) {
  displacement_ = VecX::Zero(system_->dof_count());
  for (const SolidPress& press : presses_) displacement_ += press.force * press.displacement;
  if (!is_spinning()) return true;
  const auto start = core::Clock::now();
  stress::SolidSolveSettings solving;
  solving.screening = screening_;
  solving.tolerance = settings_.solve_residual;
  const stress::SolidSolution spun =
      system_->solve(stress::centrifugal_load(*subject_.model->stiffness, *mesh_, impact_.spin_material,
                                              subject_.model->mass.centre),
                     solving);
  decision.solve_ms += core::milliseconds_since(start);
  displacement_ += spun.displacement;
  return note(spun, decision, problem);
}

}  // namespace shatterbox::fracture
