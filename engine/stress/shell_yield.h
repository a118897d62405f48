// What of a shell flows under a linear stress, layer by layer through its thickness, and the loads of what
// has flowed. In each layer the plastic strain goes along the deviator of the plane stress (von Mises), as
// far as yield_law.h says; of a cell's layers their mean, and how they bend it, are what its shape feels.
#pragma once

#include <vector>

#include "engine/stress/shell_stress.h"
#include "engine/stress/yield_law.h"

namespace shatterbox::stress {

/// Of one cell, in geometry::facet_frame: xx, yy, xy (tensor, not engineering).
struct SheetStrain {
  Vec3 membrane = Vec3::Zero();   // dimensionless
  Vec3 curvature = Vec3::Zero();  // 1/m; positive stretches the outer face
};

struct SheetFlow {
  std::vector<SheetStrain> strains;  // |cells|, plastic
  std::vector<double> works;         // |cells|, J: yield strength times equivalent strain, over the volume
  double work = 0.0;                 // J, their sum
  double volume = 0.0;               // m3, that flows
  double greatest_stress = 0.0;      // Pa, von Mises, at a face
};

/// Of `stresses` (|cells|, the linear ones at the peak).
SheetFlow find_plastic_flow(const ShellStiffness& stiffness, const geometry::ShellMesh& mesh,
                            const std::vector<CellStress>& stresses, const YieldLaw& law);

/// The plastic strain, of stretch alone, that is the size of a given one in von Mises' measure, if what flows
/// keeps its volume: 2/sqrt(3) sqrt(xx^2 + yy^2 + xx yy + xy^2).
double equivalent_strain(const Vec3& membrane);

/// The stress of a strain (xx, yy, xy, tensor); `modulus`: Young's over 1 - nu^2.
inline PlaneStress plane_stress(const Vec3& e, double modulus, double nu) {
  return {modulus * (e(0) + nu * e(1)), modulus * (e(1) + nu * e(0)), modulus * (1.0 - nu) * e(2)};
}

/// The load (|dof|, N and N m) whose answer is the shape of an unloaded shell in which these strains have
/// stayed (|cells|).
VecX eigenstrain_load(const ShellStiffness& stiffness, const geometry::ShellMesh& mesh,
                      const std::vector<SheetStrain>& strains);

}  // namespace shatterbox::stress
