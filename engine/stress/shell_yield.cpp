#include "engine/stress/shell_yield.h"

#include <algorithm>

#include "engine/core/elementary.h"
#include "engine/core/index.h"

namespace shatterbox::stress {
namespace {

using core::at;

constexpr int kLayers = 40;  // what is bent beyond 1.3 times its yield strength is told to 1 %

/// Place of a layer's middle, from -1 at the inner face to 1 at the outer.
double layer_place(int layer) {
  return (2.0 * layer + 1.0) / kLayers - 1.0;
}

/// In the plane, of a stress across which there is none.
Vec3 plane_deviator(const PlaneStress& s) {
  return {(2.0 * s(0) - s(1)) / 3.0, (2.0 * s(1) - s(0)) / 3.0, s(2)};
}

/// J, of distortion, of the linear stress.
double held_energy(const ShellStiffness& stiffness, const geometry::ShellMesh& mesh,
                   const std::vector<CellStress>& stresses, double shear) {
  double held = 0.0;
  for (std::size_t c = 0; c < stresses.size(); ++c) {
    // The square is of second order over the thickness: its mean is exact.
    const double membrane = von_mises(stresses[c].membrane), bending = von_mises(stresses[c].bending);
    held += mesh.cells[c].area * (membrane * membrane + bending * bending / 3.0);
  }
  return held * stiffness.properties.thickness / (6.0 * shear);
}

}  // namespace

SheetFlow find_plastic_flow(const ShellStiffness& stiffness, const geometry::ShellMesh& mesh,
                            const std::vector<CellStress>& stresses, const YieldLaw& law) {
  const ShellProperties& properties = stiffness.properties;
  const double shear = properties.youngs_modulus / (2.0 * (1.0 + properties.poisson_ratio));
  const double gain = flow_gain(law, held_energy(stiffness, mesh, stresses, shear));
  SheetFlow flow;
  flow.strains.resize(stresses.size());
  flow.works.assign(stresses.size(), 0.0);
  for (std::size_t c = 0; c < stresses.size(); ++c) {
    const CellStress& stress = stresses[c];
    const double greatest =
        std::max(von_mises(stress.at(ShellFace::outer)), von_mises(stress.at(ShellFace::inner)));
    flow.greatest_stress = std::max(flow.greatest_stress, greatest);
    if (!(greatest > law.yield)) continue;
    const double volume = mesh.cells[c].area * properties.thickness / kLayers;
    SheetStrain& strain = flow.strains[c];
    for (int layer = 0; layer < kLayers; ++layer) {
      const double place = layer_place(layer);
      const PlaneStress here = stress.membrane + place * stress.bending;
      const double linear = von_mises(here);
      const double equivalent = flow_strain(law, linear, shear, gain);
      if (!(equivalent > 0.0)) continue;
      const Vec3 plastic = 1.5 * equivalent / linear * plane_deviator(here);
      strain.membrane += plastic / kLayers;
      strain.curvature += 6.0 * place / (kLayers * properties.thickness) * plastic;
      flow.works[c] += volume * law.yield * equivalent;
      flow.volume += volume;
    }
    flow.work += flow.works[c];
  }
  return flow;
}

double equivalent_strain(const Vec3& e) {
  return core::sqrt(4.0 / 3.0 * std::max(0.0, e(0) * e(0) + e(1) * e(1) + e(0) * e(1) + e(2) * e(2)));
}

VecX eigenstrain_load(const ShellStiffness& stiffness, const geometry::ShellMesh& mesh,
                      const std::vector<SheetStrain>& strains) {
  VecX load = VecX::Zero(mesh.degree_of_freedom_count());
  const double nu = stiffness.properties.poisson_ratio;
  const double thickness = stiffness.relative_thickness;
  // As make_element, of a strain instead of a displacement.
  for (std::size_t c = 0; c < strains.size(); ++c) {
    const geometry::ShellCell& cell = mesh.cells[c];
    const double area = geometry::element_area(*stiffness.elements, cell.element);
    const double membrane = area / (stiffness.length * stiffness.length * (1.0 - nu * nu));
    Eigen::Matrix<double, 6, 1> stress;
    stress << plane_stress(strains[c].membrane, membrane, nu),
        plane_stress(stiffness.length * strains[c].curvature, membrane * thickness * thickness / 12.0, nu);
    const Eigen::Matrix<double, kElementDofs, 1> force =
        stiffness.matrices[at(cell.element)].strain.transpose() * stress;
    const double factor = stiffness.force_unit() * stiffness_fraction(*stiffness.elements, cell);
    const std::array<int, kElementDofs> dofs = cell_dofs(mesh, cell);
    for (int i = 0; i < kElementDofs; ++i)
      load(dofs[at(i)]) += factor * force(i) * (i < 9 ? 1.0 : stiffness.length);
  }
  return load;
}

}  // namespace shatterbox::stress
