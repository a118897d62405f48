#include "engine/fracture/shell_dent.h"

#include <algorithm>
#include <utility>

namespace shatterbox::fracture {
namespace {

// Rounds in which flow spreads, how much more each asks for, and by how much work it must grow.
constexpr int kMostSpreads = 12;
constexpr double kLeastSpread = 1.1, kGreatestSpread = 10.0, kWorthSpread = 1.01;
constexpr double kLeastDepth = 0.05;  // of the thickness: what moves by less cannot be seen

/// Where a sheet flows as far as it can it gives way to no more force, and what is about flows in its stead:
/// as much more, everywhere, as it takes to spend `most` J, if all that flows can.
stress::SheetFlow spread_flow(const stress::ShellStiffness& stiffness, const geometry::ShellMesh& mesh,
                              const std::vector<stress::CellStress>& stresses, stress::YieldLaw law,
                              double most) {
  stress::SheetFlow flow = stress::find_plastic_flow(stiffness, mesh, stresses, law);
  for (int round = 0; round < kMostSpreads && flow.work > 0.0 && flow.work < most; ++round) {
    law.energy *= std::clamp(most / flow.work, kLeastSpread, kGreatestSpread);
    const double before = flow.work;
    flow = stress::find_plastic_flow(stiffness, mesh, stresses, law);
    if (flow.work < kWorthSpread * before) break;
  }
  return flow;
}

}  // namespace

ShellShape find_dent_shape(const ShellDent& dent) {
  const double plasticity = dent.subject.material.plasticity;
  ShellShape shape = find_shell_shape(dent.subject, dent.flow, plasticity * dent.work);
  shape.work /= plasticity;
  double depth = 0.0;
  for (const Vec3& move : moves_at(shape, 1.0)) depth = std::max(depth, move.norm());
  if (!(depth > kLeastDepth * dent.subject.thickness)) shape.way.clear();
  return shape;
}

ShellYieldFinding find_yield(const ShellSubject& subject, const VecX& displacement,
                             const DentEnergy& energy) {
  ShellYieldFinding finding;
  const material::Material& material = subject.material;
  const stress::ShellStiffness& stiffness = subject.systems->stiffness();
  const std::vector<stress::CellStress> stresses =
      stress::average_stresses(*subject.mesh, subject.systems->figures().contacts,
                               stress::cell_stresses(stiffness, *subject.mesh, displacement));
  const stress::SheetFlow flow = spread_flow(stiffness, *subject.mesh, stresses,
                                             {material.yield, material.elongation, energy.all}, energy.most);
  finding.stress = flow.greatest_stress;
  finding.takes_all = energy.most > 0.0 && flow.work >= energy.most;
  const double work = std::min(flow.work, energy.most);
  if (!(work > 0.0) || !(material.plasticity > 0.0)) return finding;
  auto dent = std::make_shared<ShellDent>();
  dent->work = work;
  dent->flowed = flow.volume;
  dent->subject = subject;
  dent->flow = flow;
  finding.dent = std::move(dent);
  return finding;
}

}  // namespace shatterbox::fracture
