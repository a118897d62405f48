// The forces on a solid that has cracked: what its new compliance and the energy left allow.
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

/// J that the own inertia of a free body, as one rigid whole, adds to what this force (N) and its moment
/// about the centre of mass (N m) do to the intact body, if that was solved without; m/N of a unit force.
double SolidForce::first_inertia(const Vec3& force, const Vec3& moment) const {
  if (first_.screening > 0.0 || !subject_.clamped_vertices.empty()) return 0.0;
  return rigid_mobility(subject_.model->mass, force, moment) / (now_.screening * now_.screening);
}

/// s, of the motion that resting contact excites on the intact body; where there is none, of its first one.
double SolidForce::excited_period() const {
  if (rest_.displacement.size() == 0) return first_.system->first_period();
  stress::SolidSolution motion;
  motion.displacement = rest_.displacement;
  motion.elastic_compliance = rest_.elastic;
  return first_.system->trial_period(motion);
}

/// Later generations are screened. Below the first frequency that adds the body's own inertia, as one rigid
/// whole.
void SolidForce::prepare_cracked() {
  if (is_cracked_) return;
  is_cracked_ = true;
  if (!has_lead_) exponent_ = stress::quantise_screening(2.0 / excited_period());
  now_.screening = stress::screening_of(exponent_);
  for (SolidPress& press : presses_)
    if (!is_resting(press))
      press.first_compliance +=
          first_inertia(press.load->direction, arm_of(subject_.model->mass, *press.load));
}

/// Leaves out the loads that the cracks have left no energy: they press no more, whatever they would meet.
void SolidForce::drop_spent(std::vector<Size>& wanted, const SolidDecision& decision) {
  std::erase_if(wanted, [&](Size i) {
    SolidPress& press = presses_[i];
    if (share_left(press.energy, decision.fracture_energy) > 0.0) return false;
    press.force = 0.0;
    press.displacement = VecX();
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
  now_.begins.assign(presses_.size() + 2, {});
  for (Size i = 0; i < presses_.size(); ++i)
    if (presses_[i].displacement.size() > 0) now_.begins[i] = carried(presses_[i].displacement);
  if (rest_.displacement.size() > 0) now_.begins[presses_.size()] = carried(rest_.displacement);
  if (spin_.displacement.size() > 0) now_.begins[presses_.size() + 1] = carried(spin_.displacement);
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
    if (!is_resting(presses_[i])) wanted.push_back(i);
  drop_spent(wanted, decision);
  if (!answer(now_, wanted, decision, problem, true)) return false;
  for (const Size i : wanted) settle_cracked_force(presses_[i], decision);
  if (!settle_resting(decision, problem)) return false;
  sum_up();
  return true;
}

}  // namespace shatterbox::fracture
