// Small solids whose stress is known in closed form: meshes, supports, loads. Shared with the tests of
// stress.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <vector>

#include "engine/geometry/solid_mesh.h"
#include "engine/stress/solid_load.h"
#include "engine/stress/solid_stress.h"
#include "engine/stress/solid_system.h"

namespace shatterbox::sandbox::study::model {

using Solids = std::shared_ptr<const geometry::SolidElements>;

Solids make_solids(geometry::TetMesh mesh);

/// A box about the origin, filled exactly.
Solids lattice_box(const Vec3& half_extent, double element_size);

using Map = std::function<Vec3(const Vec3&)>;

/// Cells of the unit cube, each in Kuhn's six tetrahedra whose diagonals alternate from cell to cell, carried
/// by `map` (of right-handed Jacobian); inner vertices are first moved by up to `jitter` of a cell.
geometry::TetMesh mapped_grid(const std::array<int, 3>& cells, const Map& map, double jitter = 0.0);
Solids mapped(const std::array<int, 3>& cells, const Map& map, double jitter = 0.0);

/// Contacts of an uncut mesh: all faces inside.
std::vector<geometry::SolidContact> whole_contacts(const geometry::SolidMesh& mesh);

stress::SolidProperties solid_properties(double poisson_ratio = 0.3);

/// Throws where there is no system.
std::shared_ptr<const stress::SolidSystem> make_solid_system(
    const std::shared_ptr<const stress::SolidStiffness>& stiffness, const geometry::SolidMesh& mesh,
    const stress::SolidSystemOptions& options = {});

/// Clamps the axes that `axes_of(position)` names (bits 1, 2, 4) of every vertex of an uncut mesh.
stress::SolidSupport clamp_where(const geometry::SolidMesh& mesh,
                                 const std::function<int(const Vec3&)>& axes_of);

/// Surface traction (Pa, of a face's centre and outward unit normal) over the border of an uncut mesh, at
/// three points a face.
VecX traction_load(const geometry::SolidMesh& mesh,
                   const std::function<Vec3(const Vec3& place, const Vec3& normal)>& traction);

/// |a - b| / |b| over all cells, volumes as weights.
double stress_difference(const geometry::SolidMesh& mesh, const std::vector<stress::SolidStress>& a,
                         const std::vector<stress::SolidStress>& b);

/// A solve to a finer residual than a strength asks for.
stress::SolidSolveSettings fine(double tolerance = 1e-11);

/// A beam of length 2, 0.2 by 0.2, about the origin, with a force of 1 N down on its top at x.
struct Beam {
  Solids solids;
  geometry::SolidMesh mesh;
  std::shared_ptr<const stress::SolidStiffness> stiffness;
  stress::SolidSkin skin;

  explicit Beam(double element_size, const stress::SolidProperties& properties = solid_properties(0.22));
  VecX hit(double x, const Vec3& force = Vec3(0.0, 0.0, -1.0)) const;
  std::vector<stress::SolidStress> stress_of(const stress::SolidSolution& solution) const;
};

}  // namespace shatterbox::sandbox::study::model
