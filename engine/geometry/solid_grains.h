// A solid's cells divided into grains: each point belongs to the grain of least energy [BHTF07] sec. VII-A,
// and energies are linear in each element, so three and more grains meet in common lines and points.
#pragma once

#include <vector>

#include "engine/geometry/solid_complex.h"

namespace shatterbox::geometry {

/// Energies of the grains at the nodes of the element mesh (|grains| x |nodes|, any unit).
using GrainEnergies = std::vector<std::vector<double>>;

/// Divides all cells of a complex by the lower envelope of the energies; their grains are numbers in
/// `energies`. Boundaries are facets of kind `grain`, tagged with `first_id` plus the later grain's number,
/// and hold. Facets between cells of one grain (where a later grain took what two others had shared) are
/// tagged -1. What was cut before is divided too, and stays open. `snap` as in SolidCutter.
void divide_into_grains(SolidComplex& complex, const GrainEnergies& energies, int first_id,
                        double snap = 1e-3);

}  // namespace shatterbox::geometry
