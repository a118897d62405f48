// The element of the shells: a constant-strain membrane triangle [BHTF07] sec. IV plus Morley's
// constant-curvature bending triangle (L. S. D. Morley 1968), 12 degrees of freedom: three displacements at
// each corner, one rotation about each edge. Matrices depend on the uncut elements alone, so all pieces of
// one body share them.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "engine/core/vec.h"
#include "engine/geometry/shell_mesh.h"

namespace shatterbox::stress {

/// What the stress of a shell needs to know about its material.
struct ShellProperties {
  double youngs_modulus = 70e9;  // Pa
  double poisson_ratio = 0.22;   // 1, from 0 to below 0.5
  double density = 2500.0;       // kg/m3
  double thickness = 0.004;      // m
  bool has_bending = true;       // false: membrane only, the paper's own variant; for closed shells
};

inline constexpr int kElementDofs = 12;

/// A cell's stiffness is its element's, scaled by its share of the area, but never by less than this: a
/// sliver that carries next to nothing would make the matrix singular ("CRACKS" measured no change from 1e-4
/// to 0.1).
inline constexpr double kLeastAreaFraction = 0.02;

/// Matrices of one whole element in units of the shell (see ShellStiffness). Degrees of freedom: corner 0, 1,
/// 2 (x, y, z each), then edge 0, 1, 2.
struct ElementMatrices {
  Eigen::Matrix<double, 6, kElementDofs, Eigen::RowMajor>
      strain;  // rows: strain xx, yy, 2xy; curvature xx, yy, 2xy
  std::array<double, kElementDofs*(kElementDofs + 1) / 2> stiffness;  // lower triangle, column after column
};

/// Element matrices of a shell, made once and shared by the whole body and all of its pieces; immutable.
/// Units: Young's modulus, mass per area and `length` are 1. A displacement of 1 is `length` metres, a
/// rotation is in rad; a force of 1 is E t length newton, a moment of 1 is E t length^2 newton metre.
struct ShellStiffness {
  std::shared_ptr<const geometry::ShellElements> elements;
  ShellProperties properties;
  double length = 1.0;                    // m, diagonal of the bounding box of the uncut elements
  double relative_thickness = 0.0;        // thickness / length
  std::vector<ElementMatrices> matrices;  // |T|
  std::vector<int> vertex_rank;  // |V| of the elements: place in the order of elimination (nested dissection)

  double force_unit() const { return properties.youngs_modulus * properties.thickness * length; }  // N
};

/// Computes all matrices and the order of elimination. Elements must have area; those without get a matrix of
/// zeros. `vertex_rank`: of elements that hang together in the same way, whose order is known; empty: none
/// is.
std::shared_ptr<const ShellStiffness> make_shell_stiffness(
    std::shared_ptr<const geometry::ShellElements> elements, const ShellProperties& properties,
    std::vector<int> vertex_rank = {});

/// Place of the x displacement of a virtual vertex in a vector of all degrees of freedom; y and z follow.
inline int vertex_dof(int vertex) {
  return 3 * vertex;
}
/// Place of the rotation of a virtual edge, about the edge from its lower- to its higher-numbered source
/// vertex.
inline int edge_dof(const geometry::ShellMesh& mesh, int edge) {
  return 3 * static_cast<int>(mesh.vertex_source.size()) + edge;
}
/// Places of a cell's 12 degrees of freedom.
std::array<int, kElementDofs> cell_dofs(const geometry::ShellMesh& mesh, const geometry::ShellCell& cell);

/// Share of its element's area by which a cell's stiffness is scaled, in [kLeastAreaFraction, 1].
double stiffness_fraction(const geometry::ShellElements& elements, const geometry::ShellCell& cell);

/// Weights of a cell's centroid for its element's corners, none below a thousandth.
Vec3 centroid_weights(const geometry::ShellMesh& mesh, const geometry::ShellCell& cell);

/// K u in SI units: u in m and rad (|dof|), result in N and N m. For tests and energies; cost: one pass over
/// the cells.
VecX apply_stiffness(const ShellStiffness& stiffness, const geometry::ShellMesh& mesh,
                     const VecX& displacement);

/// Lumped mass in SI units (|dof|): kg thrice per vertex, kg m2 per edge (from t^2/12). A cut cell's mass
/// goes to its corners by the weights of its centroid, so that mass and centre of mass are exact.
VecX lumped_mass(const ShellStiffness& stiffness, const geometry::ShellMesh& mesh);

}  // namespace shatterbox::stress
