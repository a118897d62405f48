// The element of the solids: the constant-strain tetrahedron [BHTF07] sec. IV, three displacements at each of
// four corners. What is kept depends on the uncut elements alone, so all pieces of one body share it.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "engine/core/vec.h"
#include "engine/geometry/solid_mesh.h"
#include "engine/stress/elimination_order.h"

namespace shatterbox::stress {

/// What the stress of a solid needs to know about its material.
struct SolidProperties {
  double youngs_modulus = 70e9;  // Pa
  double poisson_ratio = 0.22;   // 1, from 0 to below 0.5
  double density = 2500.0;       // kg/m3
};

/// Constant-strain tetrahedra lock in volume: from here on their stress is wrong by far more than what a
/// smaller Poisson's ratio changes.
inline constexpr double kMostPoissonRatio = 0.40;

/// A cell's stiffness is its element's, scaled by its share of the volume, but never by less than this.
inline constexpr double kLeastVolumeFraction = 0.02;

/// One whole element in units of the solid (see SolidStiffness).
struct SolidElement {
  std::array<Vec3, 4> gradients;  // of the corners' weights; zero without volume
  double volume = 0.0;
  double modulus = 1.0;  // below 1 for slivers: see make_solid_stiffness
};

/// Elements of a solid, made once and shared by the whole body and all of its pieces; immutable. Units:
/// Young's modulus, density and `length` are 1. A displacement of 1 is `length` metres, a force of 1 is E
/// length^2 newton.
struct SolidStiffness {
  std::shared_ptr<const geometry::SolidElements> elements;
  SolidProperties properties;        // the ratio as it was asked for
  double poisson_ratio = 0.0;        // as used: at most kMostPoissonRatio
  double length = 1.0;               // m, diagonal of the bounding box of the uncut elements
  std::vector<SolidElement> solids;  // |T|
  SolidVertexRank vertex_rank;

  bool is_poisson_clamped() const { return poisson_ratio < properties.poisson_ratio; }
  double force_unit() const { return properties.youngs_modulus * length * length; }  // N
  /// Lame's constants over Young's modulus.
  double lame_lambda() const { return poisson_ratio / ((1.0 + poisson_ratio) * (1.0 - 2.0 * poisson_ratio)); }
  double lame_mu() const { return 0.5 / (1.0 + poisson_ratio); }
};

/// Computes gradients and volumes. An element without volume gets zeros; one flatter than a thousandth of its
/// longest edge is made softer, so that it is no stiffer than one of that height: it carries next to nothing
/// either way, and would cost the solve thousands of iterations.
std::shared_ptr<const SolidStiffness> make_solid_stiffness(
    std::shared_ptr<const geometry::SolidElements> elements, const SolidProperties& properties);

/// Share of its element's volume by which a cell's stiffness is scaled, in [kLeastVolumeFraction, 1].
double stiffness_fraction(const SolidStiffness& stiffness, const geometry::SolidCell& cell);

/// Weights of a cell's centroid for its element's corners, none below a thousandth: no unknown is without
/// mass.
Eigen::Vector4d centroid_weights(const geometry::SolidCell& cell);

/// K u in SI units: u in m (|dof|), result in N. For tests and energies; one pass over the cells.
VecX apply_stiffness(const SolidStiffness& stiffness, const geometry::SolidMesh& mesh,
                     const VecX& displacement);

/// Lumped mass in SI units (|dof|): kg thrice per virtual vertex. A cell's mass goes to its corners by the
/// weights of its centroid, so that mass and centre of mass are exact.
VecX lumped_mass(const SolidStiffness& stiffness, const geometry::SolidMesh& mesh);

/// The connected part of each unknown (|dof|), numbered from 0 by its first vertex; -1 for unknowns in no
/// cell.
std::vector<int> part_of_dofs(const geometry::SolidMesh& mesh);

}  // namespace shatterbox::stress
