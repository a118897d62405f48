// Stress of every cell on both faces of the shell, from a displacement [BHTF07] sec. IV, and one pass of
// averaging over neighbours [BHTF07] sec. VII-A, carried through folds and never across a crack.
#pragma once

#include <array>
#include <vector>

#include "engine/core/vec.h"
#include "engine/geometry/shell_mesh.h"
#include "engine/stress/shell_stiffness.h"

namespace shatterbox::stress {

/// A plane stress (xx, yy, xy) in geometry::facet_frame, Pa (Pa s for an impulse). Tension is positive.
using PlaneStress = Vec3;

enum class ShellFace : unsigned char { outer, inner };  // on the side of the triangle's normal, and the other

struct CellStress {
  PlaneStress membrane = PlaneStress::Zero();  // N / t
  PlaneStress bending = PlaneStress::Zero();  // 6 M / t^2: on the outer face; the inner face has the opposite

  PlaneStress at(ShellFace face) const {
    return face == ShellFace::outer ? PlaneStress(membrane + bending) : PlaneStress(membrane - bending);
  }
};

struct PrincipalStress {
  double first = 0.0, second = 0.0;  // Pa, first >= second
  Vec2 direction = Vec2::UnitX();    // of the first, unit, in the facet's frame
};

/// The worse face of a cell: greater first principal stress (outer on a tie).
struct WorstStress {
  PrincipalStress principal;
  ShellFace face = ShellFace::outer;
};

PrincipalStress principal_stress(const PlaneStress& stress);
WorstStress worst_stress(const CellStress& stress);
double von_mises(const PlaneStress& stress);
/// A direction in an element's facet frame as a vector in material space.
Vec3 direction_in_space(const geometry::ShellElements& elements, int element, const Vec2& direction);

/// Stress of each cell (|cells|) under a displacement (|dof|, m and rad). Without bending its part is zero.
std::vector<CellStress> cell_stresses(const ShellStiffness& stiffness, const geometry::ShellMesh& mesh,
                                      const VecX& displacement);

/// One pass: each cell takes the area-weighted mean of itself and the cells that it has contact with. Tensors
/// turn with the fold: the parts along and across the shared edge stay. `contacts` from
/// geometry::find_cell_contacts.
std::vector<CellStress> average_stresses(const geometry::ShellMesh& mesh,
                                         const std::vector<geometry::CellContact>& contacts,
                                         const std::vector<CellStress>& stresses);

/// Stress that varies linearly over a cell; places are in its element's facet frame, m from corner 0.
struct LinearStress {
  CellStress mean;                         // as average_stresses, which is the stress at `centre`
  Vec2 centre = Vec2::Zero();              // m, of the cell and its neighbours together
  std::array<CellStress, 2> slope;         // Pa/m along x and y
  CellStress at(const Vec2& place) const;  // m
};

/// A point of an element, by the weights of its corners 1 and 2, in the element's facet frame: m from corner
/// 0.
Vec2 place_in_frame(const geometry::ShellElements& elements, int element, const Mat3& frame,
                    const Vec2& barycentric);

/// Fits a plane through the stresses of each cell and of those that it has contact with, by least squares,
/// areas as weights, neighbours unfolded into the cell's plane. Exact for a stress that varies linearly. The
/// slope is zero where the neighbours do not span one.
std::vector<LinearStress> fit_stresses(const geometry::ShellMesh& mesh,
                                       const std::vector<geometry::CellContact>& contacts,
                                       const std::vector<CellStress>& stresses);

/// sum of factor_i * stress_i, cell by cell; all of the same size.
std::vector<CellStress> combine_stresses(const std::vector<std::vector<CellStress>>& stresses,
                                         const std::vector<double>& factors);

}  // namespace shatterbox::stress
