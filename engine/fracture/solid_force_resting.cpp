// Resting contact on a solid, all of it one load: what presses a body from many sides holds it together, and
// most of it does no work by itself.
#include <algorithm>
#include <utility>

#include "engine/core/clock.h"
#include "engine/core/index.h"
#include "engine/fracture/solid_force.h"

namespace shatterbox::fracture {
namespace {

using Size = std::size_t;
using core::at;

}  // namespace

/// Where the duration is given, contact is not told from a hit.
bool SolidForce::is_resting(const SolidPress& press) const {
  return !impact_.given_duration && press.load->is_resting && !is_collision(*press.load);
}

double SolidForce::resting_share() const {
  double resting = 0.0, all = 0.0;
  for (const SolidPress& press : presses_) {
    all += press.first_force;
    if (is_resting(press)) resting += press.first_force;
  }
  return all > 0.0 ? resting / all : 0.0;
}

/// N, |dof|, of these as they press on the intact body; empty: nothing does.
VecX SolidForce::resting_force(const SolidStage& stage, const std::vector<Size>& presses) const {
  VecX sum;
  for (const Size i : presses) {
    const VecX* force = stage.heaviest_force(i);
    if (!force) continue;
    if (sum.size() == 0) sum = VecX::Zero(stage.system->dof_count());
    sum += presses_[i].first_force * *force;
  }
  return sum;
}

/// `answer`: of the intact body under these.
RestingPart SolidForce::make_resting_part(std::vector<Size> presses, const WholeLoad& answer) const {
  RestingPart part;
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
  for (const Size i : presses) {
    const ImpactLoad& load = *presses_[i].load;
    const double newtons = presses_[i].first_force;
    part.contact += newtons * newtons * presses_[i].contact.hertz_compliance;
    part.inertia += newtons * newtons * load.other_inverse_mass;
    force += newtons * load.direction;
    moment += newtons * arm_of(subject_.model->mass, load);
  }
  part.energy = 0.5 * (part.contact + answer.elastic);
  part.first_compliance = answer.compliance + (is_cracked_ ? first_inertia(force, moment) : 0.0);
  part.presses = std::move(presses);
  return part;
}

/// Who presses on which connected part of the mesh last solved, and what the intact body was to those alone.
bool SolidForce::part_resting(SolidDecision& decision, std::string& problem) {
  std::vector<std::vector<Size>> pressing(at(now_.system->part_count()));
  for (const Size i : resting_)
    if (const int part = now_.part_of(i); part >= 0) pressing[at(part)].push_back(i);
  std::erase_if(pressing, [](const std::vector<Size>& presses) { return presses.empty(); });
  std::sort(pressing.begin(), pressing.end());
  const auto is_as_before = [](const std::vector<Size>& presses, const RestingPart& part) {
    return presses == part.presses;
  };
  if (std::equal(pressing.begin(), pressing.end(), rest_parts_.begin(), rest_parts_.end(), is_as_before))
    return true;
  rest_parts_.clear();
  if (pressing.size() == 1 && pressing.front() == resting_) {
    rest_parts_.push_back(make_resting_part(resting_, first_rest_));
    return true;
  }
  const auto start = core::Clock::now();
  std::vector<VecX> forces;
  for (const std::vector<Size>& presses : pressing) {
    forces.push_back(resting_force(first_, presses));
    if (forces.back().size() == 0) forces.back() = VecX::Zero(first_.system->dof_count());
  }
  stress::SolidSolveSettings solving;
  solving.screening = first_.screening;
  solving.tolerance = settings_.solve_residual;
  const std::vector<stress::SolidSolution> all = first_.system->solve(forces, solving);
  decision.solve_ms += core::milliseconds_since(start);
  for (Size k = 0; k < all.size(); ++k) {
    if (!note(all[k], decision, problem)) return false;
    rest_parts_.push_back(
        make_resting_part(std::move(pressing[k]), {{}, {}, all[k].compliance, all[k].elastic_compliance}));
  }
  return true;
}

/// Which share of resting contact each connected part still bears.
bool SolidForce::settle_resting(SolidDecision& decision, std::string& problem) {
  if (rest_.displacement.size() == 0) return true;
  if (!part_resting(decision, problem)) return false;
  const VecX stiff = apply_stiffness(*subject_.model->stiffness, *now_.mesh, rest_.displacement);
  std::vector<double> elastic(at(now_.system->part_count()), 0.0);
  for (Size v = 0; v < now_.system->part_of_vertex().size(); ++v) {
    const auto row = static_cast<Eigen::Index>(3 * v);
    const int part = now_.system->part_of_vertex()[v];
    if (part >= 0) elastic[at(part)] += rest_.displacement.segment<3>(row).dot(stiff.segment<3>(row));
  }
  const VecX moved = rest_.rigid.size() > 0 ? VecX(rest_.displacement + rest_.rigid) : rest_.displacement;
  for (RestingPart& part : rest_parts_) {
    double compliance = 0.0;
    for (const Size i : part.presses)
      compliance += presses_[i].first_force * now_.heaviest_force(i)->dot(moved);
    const double others = part.inertia / (now_.screening * now_.screening);
    const double left = share_left(part.energy, decision.fracture_energy);
    part.share = 1.0;
    // What gives way nowhere, forces on what is held, does no work and stays.
    if (part.contact + compliance + others > 0.0)
      part.share = cracked_force(1.0, part.contact, part.first_compliance, compliance, others, left);
    // The springs cannot hold more than the energy that is left.
    const double springs = part.contact + elastic[at(now_.part_of(part.presses.front()))];
    if (springs > 0.0) part.share = std::min(part.share, force_of_energy(part.energy * left, springs));
    for (const Size i : part.presses) presses_[i].force = part.share * presses_[i].first_force;
  }
  return true;
}

void SolidForce::add_resting() {
  if (!is_cracked_) {
    displacement_ += rest_.displacement;
    return;
  }
  std::vector<double> shares(at(now_.system->part_count()), 0.0);
  for (const RestingPart& part : rest_parts_) shares[at(now_.part_of(part.presses.front()))] = part.share;
  for (Size v = 0; v < now_.system->part_of_vertex().size(); ++v) {
    const auto row = static_cast<Eigen::Index>(3 * v);
    const int part = now_.system->part_of_vertex()[v];
    if (part >= 0) displacement_.segment<3>(row) += shares[at(part)] * rest_.displacement.segment<3>(row);
  }
}

}  // namespace shatterbox::fracture
