#include "engine/fracture/solid_dent.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/core/index.h"
#include "engine/fracture/copies.h"
#include "engine/fracture/dent_shape.h"
#include "engine/fracture/torn_solid.h"
#include "engine/geometry/crack_lips.h"
#include "engine/geometry/solid_deform.h"
#include "engine/stress/solid_stress.h"
#include "engine/stress/solid_yield.h"

namespace shatterbox::fracture {
namespace {

using core::at;

constexpr double kDentTolerance = 1e-4;  // of the solve for the shape, whose displacement is seen
constexpr double kLeastElement = 0.3;    // of an element's volume, that a dent leaves
constexpr double kMostSwelling = 0.03;  // of the solid's volume: beyond it the shape is none that flow leaves
constexpr double kCrushStep = 0.8;      // by which a dent is cut until that is so
constexpr int kMostCrushSteps = 40;

/// Moves of the elements' vertices; copies of one, on both sides of a standing crack, share their mean.
std::vector<Vec3> moves_of(const geometry::SolidMesh& mesh, const VecX& displacement) {
  return mean_of_copies(
      mesh.vertex_source, mesh.elements->mesh.positions.size(), Vec3(Vec3::Zero()),
      [&](int v) { return Vec3(displacement.segment<3>(3 * static_cast<Eigen::Index>(v))); });
}

bool is_sound(const geometry::SolidComplex& complex, const std::vector<Vec3>& moves) {
  return geometry::least_volume_share(complex, moves) >= kLeastElement &&
         std::abs(geometry::volume_share(complex, moves) - 1.0) <= kMostSwelling;
}

/// Where the dent's strains leave the element mesh's vertices, of that displacement to first order.
std::vector<Vec3> turned_moves(const SolidModel& model, const TornSolid* torn, const VecX& displacement) {
  std::vector<Vec3> moves = moves_of(model.mesh, turn_dent_shape(model, displacement));
  if (torn) part_lips(torn->copied, moves);
  return moves;
}

std::vector<stress::SolidStress> averaged_stresses(const SolidModel& model, const VecX& displacement) {
  return stress::average_stresses(model.mesh, model.contacts,
                                  stress::cell_stresses(*model.stiffness, model.mesh, displacement));
}

}  // namespace

double greatest_von_mises(const SolidModel& model, const VecX& displacement) {
  double greatest = 0.0;
  for (const stress::SolidStress& s : averaged_stresses(model, displacement))
    greatest = std::max(greatest, stress::von_mises(s));
  return greatest;
}

std::vector<Vec3> moves_of_share(const SolidDent& dent, double share, const LeftDents& before) {
  const geometry::SolidMesh& mesh = dent.model->mesh;
  if (before.elements != dent.model->complex->elements)
    return share == 1.0 ? dent.moves : turned_moves(*dent.model, dent.torn.get(), share * dent.displacement);
  VecX all = share * dent.displacement;
  for (std::size_t v = 0; v < mesh.vertex_source.size(); ++v)
    all.segment<3>(static_cast<Eigen::Index>(3 * v)) += before.displacement[at(mesh.vertex_source[v])];
  std::vector<Vec3> moves = turned_moves(*dent.model, dent.torn.get(), all);
  for (std::size_t v = 0; v < moves.size(); ++v) moves[v] -= before.moves[v];
  return moves;
}

void leave(const SolidDent& dent, double share, const std::vector<Vec3>& moves, LeftDents& left) {
  if (moves.size() != dent.model->complex->elements->mesh.positions.size()) return;
  if (left.elements != dent.model->complex->elements) {
    left.elements = dent.model->complex->elements;
    left.displacement.assign(moves.size(), Vec3::Zero());
    left.moves = left.displacement;
  }
  const std::vector<Vec3> displacement = moves_of(dent.model->mesh, dent.displacement);
  for (std::size_t v = 0; v < moves.size(); ++v) {
    left.displacement[v] += share * displacement[v];
    left.moves[v] += moves[v];
  }
}

namespace {

YieldFinding find_yield(const std::shared_ptr<const SolidModel>& model,
                        const std::shared_ptr<const TornSolid>& torn, const material::Material& material,
                        const VecX& displacement, const DentEnergy& energy) {
  YieldFinding finding;
  const stress::SolidStiffness& stiffness = *model->stiffness;
  stress::PlasticFlow flow =
      stress::find_plastic_flow(stiffness, model->mesh, averaged_stresses(*model, displacement),
                                {material.yield, material.elongation, energy.all});
  finding.stress = flow.greatest_stress;
  const double factor = flow.work > energy.most ? energy.most / flow.work : 1.0;
  if (!(flow.work > 0.0) || !(factor * material.plasticity > 0.0)) return finding;
  for (stress::SolidStress& strain : flow.strains) strain *= factor * material.plasticity;

  stress::SolidSolveSettings settings;
  settings.tolerance = kDentTolerance;
  stress::SolidSolution shape =
      model->system->solve(stress::eigenstrain_load(stiffness, model->mesh, flow.strains), settings);
  if (!shape.is_evaluated()) return finding;
  auto dent = std::make_shared<SolidDent>();
  dent->model = model;
  dent->torn = torn;
  if (torn) dent->torn_area = torn->area;
  dent->displacement = std::move(shape.displacement);
  dent->work = factor * flow.work;
  dent->flowed = flow.volume;
  for (int step = 0;; ++step) {
    dent->moves = turned_moves(*model, torn.get(), dent->displacement);
    if (is_sound(*model->complex, dent->moves)) break;
    if (step == kMostCrushSteps) return finding;
    dent->is_cut = true;
    dent->displacement *= kCrushStep;
  }
  finding.dent = std::move(dent);
  return finding;
}

}  // namespace

YieldFinding find_yield(const std::shared_ptr<const SolidModel>& model, const material::Material& material,
                        const VecX& displacement, const DentEnergy& energy) {
  return find_yield(model, std::shared_ptr<const TornSolid>(), material, displacement, energy);
}

YieldFinding find_yield(const std::shared_ptr<const TornSolid>& torn, const material::Material& material,
                        const VecX& displacement, const DentEnergy& energy) {
  return find_yield(torn->model, torn, material, carry(*torn, displacement), energy);
}

}  // namespace shatterbox::fracture
