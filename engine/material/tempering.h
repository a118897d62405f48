// Sheets with stress stored in them, as toughened glass has it: compression at both faces, tension between,
// parabolic over the thickness and the same in all directions of the sheet: s (6 z^2 / t^2 - 1/2) of
// compression at z from the middle, s = `surface_compression`. A sheet that holds enough of it breaks into
// dice wherever it is broken: a crack lives on what it sets free, and runs and branches until too little is
// left between its neighbours.
#pragma once

#include "engine/material/material.h"

namespace shatterbox::material {

/// The tension (Pa) by loads of a linear solve that the weakest usual flaw of a face bears: at which the
/// material fails, and the compression that loads must first undo.
double borne_tension(const Material& material);

/// Elastic energy stored in a square metre of a sheet `thickness` m thick, J/m2: (1 - nu) s^2 t / (5 E).
double stored_energy(const Material& material, double thickness);

/// The share of its stored energy that a disc `diameter` thicknesses wide sets free when it is cut out of the
/// sheet, in [0, 1]; from 2 thicknesses on only a rim of it does. From axisymmetric finite elements at
/// Poisson's ratio 0.22 (3 % more at 0.3, 5 % less at 0.1).
double released_share(double diameter);

/// Mean area (m2) of the dice of a sheet: as small as still pays for the cracks about them with
/// `kBranchingEnergy` times the fracture energy each, which is what a crack needs to branch. 0 where not even
/// a lone crack sets so much free: then the sheet breaks as if nothing were stored.
double die_area(const Material& material, double thickness);

/// Energy release rate at which a crack branches, in fracture energies: the square of 2.0 MPa sqrt(m), the
/// constant of branching cracks in soda-lime glass [Qui20], over its K_Ic of 0.75.
inline constexpr double kBranchingEnergy = 7.1;

/// Length of crack to a square root of a die's area, each crack counted for the two dice beside it: half the
/// outline of a mean cell of seeds that keep apart.
inline constexpr double kCrackToDie = 1.91;

}  // namespace shatterbox::material
