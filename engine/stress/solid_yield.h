// What of a solid flows under a linear stress, and the shape that the flow leaves it in. The plastic strain
// goes along the deviator of the stress (von Mises); how far, says yield_law.h.
#pragma once

#include <vector>

#include "engine/stress/solid_stress.h"
#include "engine/stress/yield_law.h"

namespace shatterbox::stress {

struct PlasticFlow {
  /// Per cell: xx, yy, zz, yz, zx, xy of the plastic strain (tensor, not engineering), without a trace.
  std::vector<SolidStress> strains;
  double work = 0.0;             // J: yield strength times equivalent strain, over the volume
  double volume = 0.0;           // m3, that flows
  double greatest_stress = 0.0;  // Pa, von Mises
};

/// Of `stresses` (|cells|, Pa, the linear ones at the peak).
PlasticFlow find_plastic_flow(const SolidStiffness& stiffness, const geometry::SolidMesh& mesh,
                              const std::vector<SolidStress>& stresses, const YieldLaw& law);

/// The load (|dof|, N) whose answer is the shape of an unloaded solid in which these strains have stayed.
VecX eigenstrain_load(const SolidStiffness& stiffness, const geometry::SolidMesh& mesh,
                      const std::vector<SolidStress>& strains);

}  // namespace shatterbox::stress
