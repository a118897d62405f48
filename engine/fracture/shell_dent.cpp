#include "engine/fracture/shell_dent.h"

#include <algorithm>
#include <utility>

namespace shatterbox::fracture {
namespace {

constexpr double kLeastDepth = 0.05;  // of the thickness: what moves by less cannot be seen

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
  stress::SheetFlow flow = stress::find_plastic_flow(stiffness, *subject.mesh, stresses,
                                                     {material.yield, material.elongation, energy.all});
  finding.stress = flow.greatest_stress;
  finding.takes_all = energy.most > 0.0 && flow.work >= energy.most;
  const double work = std::min(flow.work, energy.most);
  if (!(work > 0.0) || !(material.plasticity > 0.0)) return finding;
  auto dent = std::make_shared<ShellDent>();
  dent->work = work;
  dent->flowed = flow.volume;
  dent->subject = subject;
  dent->flow = std::move(flow);
  finding.dent = std::move(dent);
  return finding;
}

}  // namespace shatterbox::fracture
