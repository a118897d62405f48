// The forces on a solid that has cracked: what its new compliance and the energy left allow, and which
// resting contact is not next to nothing any more.
#include <algorithm>
#include <utility>

#include "engine/core/clock.h"
#include "engine/core/index.h"
#include "engine/fracture/solid_force.h"
#include "engine/stress/shell_system_cache.h"

namespace shatterbox::fracture {
namespace {

using Size = std::size_t;
using core::at;

}  // namespace

/// m/N that the own inertia of a free body, as one rigid whole, adds to the compliance of the intact body, if
/// that was solved without.
double SolidForce::first_inertia(const SolidPress& press) const {
  if (first_.screening > 0.0 || !subject_.clamped_vertices.empty()) return 0.0;
  return rigid_mobility(subject_.model->mass, *press.load) / (now_.screening * now_.screening);
}

/// Later generations are screened. Below the first frequency that adds the body's own inertia, as one rigid
/// whole.
void SolidForce::prepare_cracked() {
  if (is_cracked_) return;
  is_cracked_ = true;
  if (!has_lead_) exponent_ = stress::quantise_screening(2.0 / first_.system->first_period());
  now_.screening = stress::screening_of(exponent_);
  for (SolidPress& press : presses_) press.first_compliance += first_inertia(press);
}

/// The greatest force of a load that was solved for, by connected part, N.
std::vector<double> SolidForce::part_forces() const {
  std::vector<double> forces(at(now_.system->part_count()), 0.0);
  for (Size i = 0; i < presses_.size(); ++i) {
    if (presses_[i].is_minor) continue;
    std::vector<double> own(forces.size(), 0.0);
    for (Size g = 0; g < presses_[i].shares.size(); ++g)
      if (const int part = now_.part_of(i, g); part >= 0)
        own[at(part)] += presses_[i].force * presses_[i].shares[g];
    for (Size p = 0; p < own.size(); ++p) forces[p] = std::max(forces[p], own[p]);
  }
  return forces;
}

/// Where the force of the others has fallen, or a part came off with resting contact alone, that counts: from
/// now on it is solved for.
bool SolidForce::promote_minor(SolidDecision& decision, std::string& problem) {
  std::vector<std::pair<double, Size>> minor;
  for (Size i = 0; i < presses_.size(); ++i)
    if (presses_[i].is_minor) minor.push_back({presses_[i].first_force, i});
  if (minor.empty()) return true;
  std::sort(minor.begin(), minor.end());
  const std::vector<double> greatest = part_forces();
  std::vector<double> sums(greatest.size(), 0.0);
  std::vector<Size> promoted;
  for (const auto& [force, i] : minor) {
    const int part = now_.groups[i].forces.empty() ? -1 : now_.part_of(i, now_.heaviest_group(i));
    if (part < 0) continue;
    sums[at(part)] += force;
    if (sums[at(part)] > kMinorForce * greatest[at(part)]) promoted.push_back(i);
  }
  if (promoted.empty()) return true;
  if (!answer(first_, promoted, decision, problem)) return false;
  for (const Size i : promoted) {
    SolidPress& press = presses_[i];
    press.is_minor = false;
    press.energy =
        0.5 * press.force * press.force * (press.contact.hertz_compliance + press.elastic_compliance);
    press.first_compliance = press.compliance + first_inertia(press);
  }
  drop_spent(promoted, decision);
  if (!answer(now_, promoted, decision, problem, true)) return false;
  for (const Size i : promoted) settle_cracked_force(presses_[i], decision);
  return true;
}

/// Leaves out the loads that the cracks have left no energy: they press no more, whatever they would meet.
void SolidForce::drop_spent(std::vector<Size>& wanted, const SolidDecision& decision) {
  std::erase_if(wanted, [&](Size i) {
    SolidPress& press = presses_[i];
    if (share_left(press.energy, decision.fracture_energy) > 0.0) return false;
    press.force = 0.0;
    press.displacement = VecX();
    press.shares.clear();
    return true;
  });
}

void SolidForce::settle_cracked_force(SolidPress& press, const SolidDecision& decision) {
  const double hertz = press.contact.hertz_compliance;
  const double other = press.load->other_inverse_mass / (now_.screening * now_.screening);
  const double left = share_left(press.energy, decision.fracture_energy);
  press.force =
      cracked_force(press.first_force, hertz, press.first_compliance, press.compliance, other, left);
  // The springs cannot hold more than the energy that is left.
  press.force = std::min(press.force, force_of_energy(press.energy * left, hertz + press.elastic_compliance));
}

/// What was solved before, on the mesh as it is now: most of it has hardly changed.
void SolidForce::carry_over(const geometry::SolidMesh& mesh, const std::vector<int>& origins) {
  std::vector<int> source(mesh.vertex_source.size(), -1);
  for (Size c = 0; c < mesh.cells.size(); ++c)
    for (Size k = 0; k < 4; ++k)
      source[at(mesh.cells[c].vertices[k])] = now_.mesh->cells[at(origins[c])].vertices[k];
  const auto carried = [&](const VecX& before) {
    VecX now = VecX::Zero(static_cast<Eigen::Index>(3 * source.size()));
    for (Size v = 0; v < source.size(); ++v)
      if (source[v] >= 0) now.segment<3>(static_cast<Eigen::Index>(3 * v)) = before.segment<3>(3 * source[v]);
    return now;
  };
  now_.begins.assign(presses_.size() + 1, {});
  for (Size i = 0; i < presses_.size(); ++i)
    if (!presses_[i].is_minor && presses_[i].displacement.size() > 0)
      now_.begins[i] = carried(presses_[i].displacement);
  if (rest_displacement_.size() > 0) now_.begins.back() = carried(rest_displacement_);
}

bool SolidForce::settle_again(SolidForm form, const std::vector<int>& origins, SolidDecision& decision,
                              std::string& problem) {
  prepare_cracked();
  carry_over(form.mesh, origins);
  form_ = std::move(form);
  now_.mesh = &form_.mesh;
  now_.skin = &form_.skin;
  find_groups();
  const auto start = core::Clock::now();
  stress::SolidSystemOptions options;
  options.support = support_of(form_.mesh, subject_.clamped_vertices);
  const auto system = stress::SolidSystem::make(subject_.model->stiffness, form_.mesh, options);
  decision.solve_ms += core::milliseconds_since(start);
  if (!system) {
    problem = system.error();
    return false;
  }
  now_.system = system.value();
  std::vector<Size> wanted;
  for (Size i = 0; i < presses_.size(); ++i)
    if (!presses_[i].is_minor) wanted.push_back(i);
  drop_spent(wanted, decision);
  if (!answer(now_, wanted, decision, problem, true)) return false;
  for (const Size i : wanted) settle_cracked_force(presses_[i], decision);
  if (!promote_minor(decision, problem)) return false;
  sum_up();
  return true;
}

}  // namespace shatterbox::fracture
