// Stress of every cell of a solid from a displacement [BHTF07] sec. IV, and one pass of averaging over
// neighbours [BHTF07] sec. VII-A, never across a crack.
#pragma once

#include <array>
#include <vector>

#include "engine/core/vec.h"
#include "engine/geometry/solid_mesh.h"
#include "engine/stress/principal_axes.h"
#include "engine/stress/solid_stiffness.h"

namespace shatterbox::stress {

/// A stress (xx, yy, zz, yz, zx, xy) in material space, Pa (Pa s for an impulse). Tension is positive.
using SolidStress = Eigen::Matrix<double, 6, 1>;

Mat3 stress_tensor(const SolidStress& stress);
PrincipalAxes principal_axes(const SolidStress& stress);
/// At least the first principal value, and no more than a third of von Mises' stress above it, Pa.
double most_tension(const SolidStress& stress);
double von_mises(const SolidStress& stress);
/// Frobenius norm of the tensor: no principal stress is above it.
double stress_norm(const SolidStress& stress);

/// Stress of each cell (|cells|) under a displacement (|dof|, m).
std::vector<SolidStress> cell_stresses(const SolidStiffness& stiffness, const geometry::SolidMesh& mesh,
                                       const VecX& displacement);

/// One pass: each cell takes the volume-weighted mean of itself and the cells that it has contact with.
/// `contacts`: of the mesh, those alone over which material holds (none across a crack).
std::vector<SolidStress> average_stresses(const geometry::SolidMesh& mesh,
                                          const std::vector<geometry::SolidContact>& contacts,
                                          const std::vector<SolidStress>& stresses);

/// Stress that varies linearly over a cell and its neighbours; places in material space, m.
struct LinearSolidStress {
  SolidStress mean = SolidStress::Zero();  // as average_stresses, which is the stress at `centre`
  Vec3 centre = Vec3::Zero();              // m, of the cell and its neighbours together
  std::array<SolidStress, 3> slope{SolidStress::Zero(), SolidStress::Zero(), SolidStress::Zero()};  // Pa/m
  SolidStress at(const Vec3& place) const;
};

/// Fits a linear stress to each cell and those that it has contact with, by least squares, volumes as
/// weights. Exact for a stress that varies linearly. The slope is zero where the neighbours do not span one.
std::vector<LinearSolidStress> fit_stresses(const geometry::SolidMesh& mesh,
                                            const std::vector<geometry::SolidContact>& contacts,
                                            const std::vector<SolidStress>& stresses);

/// sum of factor_i * stress_i, cell by cell; all of the same size.
std::vector<SolidStress> combine_stresses(const std::vector<std::vector<SolidStress>>& stresses,
                                          const std::vector<double>& factors);

/// Centroid of a cell's material in material space, m.
Vec3 cell_centroid(const geometry::SolidMesh& mesh, const geometry::SolidCell& cell);

}  // namespace shatterbox::stress
