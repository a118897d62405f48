#include "engine/stress/solid_yield.h"

#include <algorithm>

#include "engine/core/index.h"

namespace shatterbox::stress {

using core::at;

PlasticFlow find_plastic_flow(const SolidStiffness& stiffness, const geometry::SolidMesh& mesh,
                              const std::vector<SolidStress>& stresses, const YieldLaw& law) {
  PlasticFlow flow;
  flow.strains.assign(stresses.size(), SolidStress::Zero());
  const double shear = stiffness.properties.youngs_modulus * stiffness.lame_mu();
  double held = 0.0;  // J, of distortion
  for (std::size_t c = 0; c < stresses.size(); ++c) {
    const double linear = von_mises(stresses[c]);
    held += std::max(0.0, mesh.cells[c].volume) * linear * linear / (6.0 * shear);
  }
  const double gain = flow_gain(law, held);
  for (std::size_t c = 0; c < stresses.size(); ++c) {
    const double linear = von_mises(stresses[c]);
    flow.greatest_stress = std::max(flow.greatest_stress, linear);
    if (!(linear > law.yield)) continue;
    const double equivalent = flow_strain(law, linear, shear, gain);
    SolidStress deviator = stresses[c];
    deviator.head<3>().array() -= stresses[c].head<3>().sum() / 3.0;
    flow.strains[c] = 1.5 * equivalent / linear * deviator;
    const double volume = std::max(0.0, mesh.cells[c].volume);
    flow.work += volume * law.yield * equivalent;
    flow.volume += volume;
  }
  return flow;
}

VecX eigenstrain_load(const SolidStiffness& stiffness, const geometry::SolidMesh& mesh,
                      const std::vector<SolidStress>& strains) {
  VecX load = VecX::Zero(mesh.degree_of_freedom_count());
  for (std::size_t c = 0; c < strains.size(); ++c) {
    const geometry::SolidCell& cell = mesh.cells[c];
    const SolidElement& element = stiffness.solids[at(cell.element)];
    // As apply_stiffness, of a strain instead of a displacement.
    const double pressure = stiffness.lame_lambda() * strains[c].head<3>().sum();
    const Mat3 stress = element.modulus *
                        (2.0 * stiffness.lame_mu() * stress_tensor(strains[c]) + pressure * Mat3::Identity());
    const double factor = stiffness.force_unit() * element.volume * stiffness_fraction(stiffness, cell);
    for (std::size_t i = 0; i < 4; ++i)
      load.segment<3>(3 * cell.vertices[i]) += factor * (stress * element.gradients[i]);
  }
  return load;
}

}  // namespace shatterbox::stress
