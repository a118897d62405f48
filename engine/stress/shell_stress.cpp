#include "engine/stress/shell_stress.h"

#include <algorithm>
#include <array>

#include "engine/core/elementary.h"
#include "engine/core/parallel.h"

namespace shatterbox::stress {
namespace {

using Size = std::size_t;

Size at(int i) {
  return static_cast<Size>(i);
}

/// A plane stress in the axes `along` and its left-hand normal, from those of the frame; the other way for
/// `back`.
PlaneStress turn(const PlaneStress& s, const Vec2& along) {
  const double c = along.x(), d = along.y();
  return {c * c * s(0) + d * d * s(1) + 2.0 * c * d * s(2), d * d * s(0) + c * c * s(1) - 2.0 * c * d * s(2),
          c * d * (s(1) - s(0)) + (c * c - d * d) * s(2)};
}

PlaneStress turn_back(const PlaneStress& s, const Vec2& along) {
  return turn(s, Vec2(along.x(), -along.y()));
}

/// What averaging needs to know of a contact across an edge.
struct Fold {
  Vec2 along_a, along_b;  // the edge in both frames
  bool is_flipped;        // the two triangles see the edge in the same direction: their normals disagree
};

Fold find_fold(const geometry::ShellMesh& mesh, const std::vector<Mat3>& frames,
               const geometry::CellContact& contact) {
  const geometry::ShellElements& elements = *mesh.elements;
  const auto edge_of = [&](int c, int side) {
    const geometry::ShellCell& cell = mesh.cells[at(c)];
    const Size i = at(mesh.corners[at(cell.first_corner + side)].side_id);
    const geometry::Triangle& t = elements.mesh.triangles[at(cell.element)];
    return std::array<int, 2>{t[i], t[(i + 1) % 3]};
  };
  const auto ends_a = edge_of(contact.cell_a, contact.side_a);
  const auto ends_b = edge_of(contact.cell_b, contact.side_b);
  const auto& positions = elements.mesh.positions;
  const Vec3 along = (positions[at(ends_a[1])] - positions[at(ends_a[0])]).normalized();
  const auto flatten = [&](int c) {
    const Mat3& frame = frames[at(c)];
    return Vec2(frame.col(0).dot(along), frame.col(1).dot(along));
  };
  return {flatten(contact.cell_a), flatten(contact.cell_b), ends_a[0] == ends_b[0]};
}

}  // namespace

PrincipalStress principal_stress(const PlaneStress& stress) {
  const double mean = 0.5 * (stress(0) + stress(1));
  const double half_difference = 0.5 * (stress(0) - stress(1));
  const double radius = core::sqrt(half_difference * half_difference + stress(2) * stress(2));
  PrincipalStress result{mean + radius, mean - radius, Vec2::UnitX()};
  // Of the two formulas for the eigenvector, the one without cancellation.
  const Vec2 direction = half_difference >= 0.0 ? Vec2(radius + half_difference, stress(2))
                                                : Vec2(stress(2), radius - half_difference);
  const double greatest = direction.cwiseAbs().maxCoeff();
  if (greatest > 0.0) result.direction = (direction / greatest).normalized();
  return result;
}

WorstStress worst_stress(const CellStress& stress) {
  const PrincipalStress outer = principal_stress(stress.at(ShellFace::outer));
  const PrincipalStress inner = principal_stress(stress.at(ShellFace::inner));
  if (inner.first > outer.first) return {inner, ShellFace::inner};
  return {outer, ShellFace::outer};
}

double von_mises(const PlaneStress& s) {
  return core::sqrt(std::max(0.0, s(0) * s(0) - s(0) * s(1) + s(1) * s(1) + 3.0 * s(2) * s(2)));
}

Vec3 direction_in_space(const geometry::ShellElements& elements, int element, const Vec2& direction) {
  const Mat3 frame = geometry::facet_frame(elements, element);
  return direction.x() * frame.col(0) + direction.y() * frame.col(1);
}

std::vector<CellStress> cell_stresses(const ShellStiffness& stiffness, const geometry::ShellMesh& mesh,
                                      const VecX& displacement) {
  const double nu = stiffness.properties.poisson_ratio;
  const double modulus = stiffness.properties.youngs_modulus / (1.0 - nu * nu);
  const auto stress_of = [&](const Vec3& strain, double factor) {
    return PlaneStress(factor * (strain(0) + nu * strain(1)), factor * (strain(1) + nu * strain(0)),
                       factor * 0.5 * (1.0 - nu) * strain(2));
  };
  std::vector<CellStress> stresses(mesh.cells.size());
  core::parallel_for(mesh.cells.size(), 512, [&](Size c) {
    const geometry::ShellCell& cell = mesh.cells[c];
    const std::array<int, kElementDofs> dofs = cell_dofs(mesh, cell);
    Eigen::Matrix<double, kElementDofs, 1> u;
    for (int i = 0; i < kElementDofs; ++i)
      u(i) = displacement(dofs[at(i)]) / (i < 9 ? stiffness.length : 1.0);
    const Eigen::Matrix<double, 6, 1> strain = stiffness.matrices[at(cell.element)].strain * u;
    stresses[c] = {stress_of(strain.head<3>(), modulus),
                   stress_of(strain.tail<3>(), 0.5 * modulus * stiffness.relative_thickness)};
  });
  return stresses;
}

std::vector<CellStress> average_stresses(const geometry::ShellMesh& mesh,
                                         const std::vector<geometry::CellContact>& contacts,
                                         const std::vector<CellStress>& stresses) {
  std::vector<Mat3> frames(mesh.cells.size());
  core::parallel_for(mesh.cells.size(), 512, [&](Size c) {
    frames[c] = geometry::facet_frame(*mesh.elements, mesh.cells[c].element);
  });
  std::vector<CellStress> sums(stresses.size());
  std::vector<double> areas(stresses.size());
  for (Size c = 0; c < stresses.size(); ++c) {
    areas[c] = mesh.cells[c].area;
    sums[c] = {areas[c] * stresses[c].membrane, areas[c] * stresses[c].bending};
  }
  const auto add = [&](int to, const Vec2& along_to, int from, const Vec2& along_from, bool is_flipped) {
    const auto carry = [&](const PlaneStress& stress) {
      PlaneStress edge = turn(stress, along_from);
      if (is_flipped) edge(2) = -edge(2);
      return turn_back(edge, along_to);
    };
    const double area = mesh.cells[at(from)].area;
    areas[at(to)] += area;
    sums[at(to)].membrane += area * carry(stresses[at(from)].membrane);
    sums[at(to)].bending += (is_flipped ? -area : area) * carry(stresses[at(from)].bending);
  };
  for (const geometry::CellContact& contact : contacts) {
    Fold fold{Vec2::UnitX(), Vec2::UnitX(), false};  // inside one element there is no fold
    if (mesh.cells[at(contact.cell_a)].element != mesh.cells[at(contact.cell_b)].element)
      fold = find_fold(mesh, frames, contact);
    add(contact.cell_a, fold.along_a, contact.cell_b, fold.along_b, fold.is_flipped);
    add(contact.cell_b, fold.along_b, contact.cell_a, fold.along_a, fold.is_flipped);
  }
  for (Size c = 0; c < sums.size(); ++c) {
    if (!(areas[c] > 0.0)) {
      sums[c] = stresses[c];
      continue;
    }
    sums[c].membrane /= areas[c];
    sums[c].bending /= areas[c];
  }
  return sums;
}

std::vector<CellStress> combine_stresses(const std::vector<std::vector<CellStress>>& stresses,
                                         const std::vector<double>& factors) {
  std::vector<CellStress> result(stresses.empty() ? 0 : stresses.front().size());
  for (Size i = 0; i < stresses.size(); ++i)
    for (Size c = 0; c < result.size(); ++c) {
      result[c].membrane += factors[i] * stresses[i][c].membrane;
      result[c].bending += factors[i] * stresses[i][c].bending;
    }
  return result;
}

}  // namespace shatterbox::stress
