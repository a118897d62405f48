#include "engine/fracture/solid_dent.h"

#include <algorithm>
#include <cmath>

#include "engine/core/index.h"
#include "engine/geometry/solid_deform.h"
#include "engine/stress/solid_stress.h"
#include "engine/stress/solid_yield.h"

namespace shatterbox::fracture {
namespace {

using core::at;

constexpr double kDentTolerance = 1e-4;  // of the solve for the shape, whose displacement is seen
constexpr double kLeastElement = 0.3;    // of an element's volume, that a dent leaves
constexpr double kCrushStep = 0.8;       // by which a dent is cut until elements keep that
constexpr int kMostCrushSteps = 40;

/// Moves of the elements' vertices; copies of one, on both sides of a standing crack, share their mean.
std::vector<Vec3> moves_of(const geometry::SolidMesh& mesh, const VecX& displacement) {
  const std::size_t count = mesh.elements->mesh.positions.size();
  std::vector<Vec3> moves(count, Vec3::Zero());
  std::vector<int> copies(count, 0);
  for (std::size_t v = 0; v < mesh.vertex_source.size(); ++v) {
    moves[at(mesh.vertex_source[v])] += displacement.segment<3>(static_cast<Eigen::Index>(3 * v));
    ++copies[at(mesh.vertex_source[v])];
  }
  for (std::size_t v = 0; v < count; ++v)
    if (copies[v] > 1) moves[v] /= copies[v];
  return moves;
}

}  // namespace

YieldFinding find_yield(const SolidModel& model, const material::Material& material, const VecX& displacement,
                        const DentEnergy& energy) {
  YieldFinding finding;
  const std::vector<stress::SolidStress> stresses = stress::average_stresses(
      model.mesh, model.contacts, stress::cell_stresses(*model.stiffness, model.mesh, displacement));
  stress::PlasticFlow flow = stress::find_plastic_flow(*model.stiffness, model.mesh, stresses,
                                                       {material.yield, material.elongation, energy.all});
  finding.stress = flow.greatest_stress;
  const double factor = flow.work > energy.most ? energy.most / flow.work : 1.0;
  if (!(flow.work > 0.0) || !(factor * material.plasticity > 0.0)) return finding;
  for (stress::SolidStress& strain : flow.strains) strain *= factor * material.plasticity;

  stress::SolidSolveSettings settings;
  settings.tolerance = kDentTolerance;
  const stress::SolidSolution shape =
      model.system->solve(stress::eigenstrain_load(*model.stiffness, model.mesh, flow.strains), settings);
  if (!shape.is_evaluated()) return finding;
  auto dent = std::make_shared<SolidDent>();
  dent->moves = moves_of(model.mesh, shape.displacement);
  dent->work = factor * flow.work;
  dent->flowed = flow.volume;
  for (int step = 0; geometry::least_volume_share(*model.complex, dent->moves) < kLeastElement; ++step) {
    if (step == kMostCrushSteps) return finding;
    dent->is_cut = true;
    for (Vec3& move : dent->moves) move *= kCrushStep;
  }
  finding.dent = std::move(dent);
  return finding;
}

}  // namespace shatterbox::fracture
