#include "engine/fracture/shell_dent.h"

#include <algorithm>
#include <utility>

#include "engine/fracture/shell_shape.h"
#include "engine/stress/shell_yield.h"

namespace shatterbox::fracture {
namespace {

constexpr double kLeastDepth = 0.05;  // of the thickness: what moves by less cannot be seen

}  // namespace

ShellYieldFinding find_yield(const ShellSubject& subject, const VecX& displacement,
                             const DentEnergy& energy) {
  ShellYieldFinding finding;
  const material::Material& material = subject.material;
  const stress::ShellStiffness& stiffness = subject.systems->stiffness();
  const geometry::ShellMesh& mesh = *subject.mesh;
  const std::vector<stress::CellStress> stresses = stress::average_stresses(
      mesh, subject.systems->figures().contacts, stress::cell_stresses(stiffness, mesh, displacement));
  const stress::SheetFlow flow =
      stress::find_plastic_flow(stiffness, mesh, stresses, {material.yield, material.elongation, energy.all});
  finding.stress = flow.greatest_stress;
  const double spent = std::min(flow.work, energy.most);
  if (!(spent > 0.0) || !(material.plasticity > 0.0)) return finding;
  ShellShape shape = find_shell_shape(subject, flow, spent);
  double depth = 0.0;
  for (Vec3& move : shape.moves) {
    move *= material.plasticity;
    depth = std::max(depth, move.norm());
  }
  if (!(depth > kLeastDepth * subject.thickness)) return finding;
  auto dent = std::make_shared<ShellDent>();
  dent->moves = std::move(shape.moves);
  dent->work = shape.work;
  dent->flowed = flow.volume;
  dent->is_cut = shape.is_cut;
  finding.dent = std::move(dent);
  return finding;
}

}  // namespace shatterbox::fracture
