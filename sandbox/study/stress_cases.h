// Stress beside closed forms: the cases of plates, discs, spheres, rings and beams that the tests hold and
// the study "stress" times.
#pragma once

#include <limits>

#include "engine/stress/solid_system.h"

namespace shatterbox::sandbox::study {

inline constexpr double kNoStress = std::numeric_limits<double>::quiet_NaN();

/// Errors are relative; those of fields are in L2. NaN: a case does not have it.
struct StressCase {
  double raw = kNoStress;            // of the stress of elements
  double averaged = kNoStress;       // after one pass of averaging, which is what a strength is compared with
  double deflection = kNoStress;     // found over exact
  double concentration = kNoStress;  // of the greatest stress, signed
  double rim = kNoStress;            // of the stress at the rim, signed
  long elements = 0;
  int iterations = 0;
  double residual = 0.0;
  double seconds = 0.0;  // processor time: stiffness, system, solve, stress, averaging
};

// Solids. `n`: elements along the case's own length; `solve`: tolerance and so on. They throw where there is
// no answer.

/// A sixth of a thick sphere, radii 1 and 2, inner pressure 1, free and in balance: Lame. n cells a right
/// angle.
StressCase thick_sphere(int n, const stress::SolidSolveSettings& solve);
/// Thick cylinder in plane strain, radii 1 and 2, inner pressure 1: Lame. n cells a quadrant.
StressCase thick_cylinder(int n, const stress::SolidSolveSettings& solve);
/// An infinite plate under tension 1 along x with a hole of radius 1, cut out at radius 6: Kirsch. n cells a
/// quadrant. `concentration` is about the top of the hole.
StressCase plate_with_hole(int n, const stress::SolidSolveSettings& solve);
/// A disc of radius 1 and thickness 0.1 that spins, in plane stress; n cells across. `concentration`: the
/// centre.
StressCase spinning_disc(int n, const stress::SolidSolveSettings& solve);
/// A cantilever 4 x 1 x 1 under a force at its end: Timoshenko's deflection, M z / I in its middle half; n
/// cells deep.
StressCase cantilever(int n, double poisson_ratio, const stress::SolidSolveSettings& solve);
/// A free beam 2 x 0.2 x 0.2 hit in the middle: M = J x^2 / 2 L outside a tenth of its length about the hit,
/// J L / 8 there (`concentration`); n elements deep.
StressCase free_beam(int n, const stress::SolidSolveSettings& solve);

// Shells. `raw`, `averaged`: of bending moments.

/// Square plate of side 1, n by n cells: `deflection` under a force in the middle; `raw`: the moment in the
/// middle under pressure; `rim`: the deflection under pressure, signed. Timoshenko & Woinowsky-Krieger.
StressCase square_plate(int n, bool is_clamped);
/// Free disc of radius 1 under a force in its middle, closed form of the relieved load; `rim`: `raw` outside
/// a quarter of the radius.
StressCase free_disc(int rings);
/// Sphere of radius 1 and thickness 0.02 under pressure, p R / 2 t: `raw` is the mean's error, `rim` the
/// worst cell's.
StressCase pressed_sphere(int level);
/// Sphere of radius 1 and thickness 0.05 under two opposite forces: `deflection` over Reissner's.
StressCase pinched_sphere(int level, bool has_bending);

}  // namespace shatterbox::sandbox::study
