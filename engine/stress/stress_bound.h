// What a given energy can do at most: a strict upper bound on the stress of a shell or a solid that costs
// nothing, so that taps which cannot break anything need no solve.
#pragma once

#include <vector>

#include "engine/geometry/shell_mesh.h"
#include "engine/stress/shell_stiffness.h"
#include "engine/stress/solid_stiffness.h"

namespace shatterbox::stress {

/// The least area over which a given elastic energy can gather in one cell's stress, m2: of plain cells, or
/// of the average of average_stresses() if `contacts` are given. A number of the mesh: keep it.
double least_stressed_area(const geometry::ShellMesh& mesh);
double least_stressed_area(const geometry::ShellMesh& mesh,
                           const std::vector<geometry::CellContact>& contacts);

/// The same for the average of each cell (|cells|), m2.
std::vector<double> stressed_areas(const geometry::ShellMesh& mesh,
                                   const std::vector<geometry::CellContact>& contacts);

/// No cell's first principal stress on either face is above this, Pa, when the elastic energy of the shell is
/// at most `energy` (J): sqrt(8 E / (1 - nu^2) * energy / (thickness * area)). The energy of a contact is at
/// most the kinetic energy m_eff v^2 / 2 before it. The stress of a spin or another load comes on top.
double stress_bound(const ShellProperties& properties, double least_area, double energy);

/// Of a solid: the volume over which a given elastic energy can gather in the averaged stress of each cell
/// (|cells|), m3; and the bound that follows for one of them, Pa: sqrt(2 E (1 - nu) / ((1 + nu) (1 - 2 nu)) *
/// energy / volume).
std::vector<double> stressed_volumes(const SolidStiffness& stiffness, const geometry::SolidMesh& mesh,
                                     const std::vector<geometry::SolidContact>& contacts);
double stress_bound(const SolidStiffness& stiffness, double volume, double energy);

/// Stress of a strip of `thickness` and `width` that is bent by `force` (N) over its whole length `reach`,
/// Pa: 6 F l / (b t^2). No shell of that size, nowhere narrower than that, has more under forces that sum to
/// it.
double bending_bound(double thickness, double width, double reach, double force);

}  // namespace shatterbox::stress
