// How breaking is done, whatever the body.
#pragma once

namespace shatterbox::fracture {

struct FractureSettings {
  int most_generations = 4;   // solves of the cracking body; 2 for speed
  double waviness = 0.06;     // rad, of crack paths
  double core_spacing = 4.0;  // crushed core: size of a shell's cells at the hit, in thicknesses; 0: no core
  double least_width = 0.0;   // m, what contact can resolve; cracks keep wider pieces than that
  bool has_energy_guard = true;
  bool may_estimate = false;     // where a first answer shows that the body holds, no better one is sought
  double solve_residual = 2e-3;  // relative, that conjugate gradients go down to
  double patch_radius =
      0.0;  // m; 0: max(Hertz radius, thickness, 0.075 body size, 1.5 element sizes); solids: 0.15 width
};

}  // namespace shatterbox::fracture
