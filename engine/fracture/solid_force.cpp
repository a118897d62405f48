#include "engine/fracture/solid_force.h"

#include <algorithm>
#include <utility>

#include "engine/core/clock.h"
#include "engine/core/index.h"
#include "engine/core/parallel.h"
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

const VecX* SolidStage::heaviest_force(Size press) const {
  const std::vector<double>& weights = groups[press].weights;
  if (weights.empty()) return nullptr;
  return &groups[press]
              .forces[static_cast<Size>(std::max_element(weights.begin(), weights.end()) - weights.begin())];
}

int SolidStage::part_of(Size press) const {
  const VecX* force = heaviest_force(press);
  if (!force) return -1;
  for (Size v = 0; v < system->part_of_vertex().size(); ++v)
    if (force->segment<3>(static_cast<Eigen::Index>(3 * v)) != Vec3::Zero())
      return system->part_of_vertex()[v];
  return -1;
}

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
  first_.mesh = &model.mesh;
  first_.skin = &model.skin;
  first_.system = model.system;
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
    if (is_resting(press)) resting_.push_back(presses_.size());
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

std::optional<LoadBound::Worst> SolidForce::harmless_bound() const {
  if (impact_.given_duration) return std::nullopt;
  if (are_snapshots(impact_)) return std::nullopt;  // a spring too deep holds more than there is
  const SolidModel& model = *subject_.model;
  if (!(model.width > 0.0)) return std::nullopt;
  const double spin = kSolidSpinSafety * spin_stress();
  const double per_newton = stress::bending_bound(model.width, model.width, model.reach, 1.0);
  const double per_root_joule = stress::stress_bound(*model.stiffness, 1.0, 1.0);
  // Of two stresses von Mises' is at most sqrt(3) times the greater.
  const double flow = subject_.material.yield > 0.0 ? subject_.material.yield / core::sqrt(3.0) : 1e300;
  const auto strength_of = [&](Size c) {
    double strength = subject_.flaws->greatest_strength;
    // The weakest is the first; whether it lies in this cell of its element does not matter to a bound.
    if (const auto flaws = subject_.flaws->of_element(model.mesh.cells[c].element); !flaws.empty())
      strength = std::min(strength, flaws.front().strength);
    return std::min(strength, flow);
  };
  return LoadBound(impact_).harmless(model.stressed_volumes, strength_of, spin, per_newton, per_root_joule);
}

void SolidForce::find_groups() {
  now_.groups.assign(presses_.size(), {});
  core::parallel_for(presses_.size(), 1, [&](Size i) {
    now_.groups[i] = find_solid_groups(*now_.mesh, *now_.skin, presses_[i].contact);
  });
}

bool SolidForce::note(const stress::SolidSolution& solution, SolidDecision& decision,
                      std::string& problem) const {
  decision.residual = std::max(decision.residual, solution.residual);
  decision.iterations += solution.iterations;
  if (!solution.is_evaluated()) problem = solution.fault;
  return solution.is_evaluated();
}

/// What a unit force of each of these loads meets, as the pieces under it share it; and, if asked, what
/// resting contact and the spin do to this mesh.
bool SolidForce::answer(const SolidStage& stage, const std::vector<Size>& wanted, SolidDecision& decision,
                        std::string& problem, bool wants_whole) {
  const auto start = core::Clock::now();
  std::vector<VecX> forces, begins;
  for (const Size i : wanted) {
    const std::vector<VecX>& own = stage.groups[i].forces;
    forces.insert(forces.end(), own.begin(), own.end());
    begins.resize(forces.size());
    // Of pieces that share a force none moves as they do together.
    if (own.size() == 1 && !stage.begins.empty()) begins.back() = stage.begins[i];
  }
  std::vector<WholeLoad*> whole;
  const auto add_whole = [&](VecX force, Size begin, WholeLoad& load) {
    load = {};
    if (force.size() == 0) return;
    forces.push_back(std::move(force));
    begins.push_back(stage.begins.empty() ? VecX() : stage.begins[begin]);
    whole.push_back(&load);
  };
  if (wants_whole) {
    add_whole(resting_force(stage, resting_), presses_.size(), rest_);
    add_whole(is_spinning() ? stress::centrifugal_load(*subject_.model->stiffness, *stage.mesh,
                                                       impact_.spin_material, subject_.model->mass.centre)
                            : VecX(),
              presses_.size() + 1, spin_);
  }
  stress::SolidSolveSettings solving;
  solving.screening = stage.screening;
  solving.tolerance = settings_.solve_residual;
  const std::vector<stress::SolidSolution> all = stage.system->solve(forces, solving, begins);
  decision.solve_ms += core::milliseconds_since(start);
  for (Size k = 0; k < whole.size(); ++k) {
    const stress::SolidSolution& solution = all[all.size() - whole.size() + k];
    if (!note(solution, decision, problem)) return false;
    *whole[k] = {solution.displacement, solution.rigid_displacement, solution.compliance,
                 solution.elastic_compliance};
  }
  auto next = all.begin();
  for (const Size i : wanted) {
    SolidPress& press = presses_[i];
    const PressGroups& groups = stage.groups[i];
    const std::vector<stress::SolidSolution> own(next,
                                                 next + static_cast<std::ptrdiff_t>(groups.forces.size()));
    next += static_cast<std::ptrdiff_t>(groups.forces.size());
    for (const stress::SolidSolution& solution : own)
      if (!note(solution, decision, problem)) return false;
    const Eigen::MatrixXd flexibility = stress::compliance_matrix(groups.forces, own);
    const Eigen::VectorXd shares = share_force(groups, flexibility);
    press.displacement = VecX::Zero(stage.system->dof_count());
    for (Eigen::Index g = 0; g < shares.size(); ++g)
      if (shares[g] != 0.0) press.displacement += shares[g] * own[static_cast<Size>(g)].displacement;
    press.compliance = shares.dot(flexibility * shares);
    press.elastic_compliance = own.size() == 1
                                   ? own.front().elastic_compliance
                                   : press.displacement.dot(apply_stiffness(*subject_.model->stiffness,
                                                                            *stage.mesh, press.displacement));
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
  if (!answer(now_, {lead}, decision, problem)) return false;
  duration_ = duration_of(presses_[lead]);
  stress::SolidSolution motion;
  motion.displacement = presses_[lead].displacement;
  motion.elastic_compliance = presses_[lead].elastic_compliance;
  exponent_ = stress::quantise_screening(1.0 / duration_);
  if (!(duration_ < 0.5 * now_.system->trial_period(motion))) return true;
  // A higher screening never makes the duration longer: the search climbs.
  std::vector<int> tried;
  now_.begins.resize(presses_.size() + 2);
  while (static_cast<int>(tried.size()) < kMostSolidScreenings &&
         std::find(tried.begin(), tried.end(), exponent_) == tried.end()) {
    tried.push_back(exponent_);
    now_.screening = stress::screening_of(exponent_);
    now_.begins[lead] = presses_[lead].displacement;
    if (!answer(now_, {lead}, decision, problem)) return false;
    duration_ = duration_of(presses_[lead]);
    exponent_ = stress::quantise_screening(1.0 / duration_);
  }
  exponent_ = tried.back();
  return true;
}

bool SolidForce::settle(SolidDecision& decision, std::string& problem) {
  now_ = first_;
  find_groups();
  duration_ = impact_.contact_average;
  std::optional<Size> lead;
  for (Size i = 0; i < presses_.size(); ++i) {
    if (!is_collision(*presses_[i].load) && !impact_.given_duration) continue;
    if (!lead || presses_[i].load->impulse > presses_[*lead].load->impulse) lead = i;
  }
  if (lead && !settle_lead(*lead, decision, problem)) return false;
  if (lead) settle_force(presses_[*lead]);
  for (const Size i : resting_) settle_force(presses_[i]);
  std::vector<Size> others;
  for (Size i = 0; i < presses_.size(); ++i)
    if (i != lead && !is_resting(presses_[i])) others.push_back(i);
  if (!answer(now_, others, decision, problem, true)) return false;
  for (SolidPress& press : presses_) settle_force(press);
  now_.begins.clear();
  first_ = now_;
  sum_up();
  return true;
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
  VecX sum = VecX::Zero(now_.system->dof_count());
  for (const SolidPress& press : presses_)
    if (!press.load->is_resting && press.force > 0.0) sum += press.force * press.displacement;
  return sum;
}

DentEnergy SolidForce::struck_energy() const {
  DentEnergy sum;
  for (const SolidPress& press : presses_)
    add_energy(*press.load, press.force, press.elastic_compliance, sum);
  return sum;
}

void SolidForce::book_energy(SolidDecision& decision) {
  for (SolidPress& press : presses_) {
    if (is_resting(press)) continue;
    press.first_compliance = press.compliance;
    const double elastic =
        0.5 * press.force * press.force * (press.contact.hertz_compliance + press.elastic_compliance);
    if (press.energy == 0.0) press.energy = elastic;
    decision.elastic_energy += std::min(elastic, press.energy);
  }
  if (rest_.displacement.size() == 0) return;
  first_rest_ = {{}, {}, rest_.compliance, rest_.elastic};
  decision.elastic_energy += make_resting_part(resting_, first_rest_).energy;
}

/// The displacement under all forces and the spin at once: the answer is linear.
void SolidForce::sum_up() {
  displacement_ = VecX::Zero(now_.system->dof_count());
  for (const SolidPress& press : presses_)
    if (press.displacement.size() > 0 && press.force > 0.0) displacement_ += press.force * press.displacement;
  if (spin_.displacement.size() > 0) displacement_ += spin_.displacement;
  if (rest_.displacement.size() > 0) add_resting();
}

}  // namespace shatterbox::fracture
