#include "engine/stress/shell_stress.h"

#include <algorithm>
#include <array>

#include "engine/core/elementary.h"
#include "engine/core/index.h"
#include "engine/core/parallel.h"

namespace shatterbox::stress {
namespace {

using Size = std::size_t;
using core::at;

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

/// One cell's view of the edge that it shares: a point on it and its direction, in the cell's frame.
struct FoldSide {
  Vec2 origin = Vec2::Zero(), along = Vec2::UnitX();
};

struct Fold {
  FoldSide a, b;
  bool is_flipped = false;  // the two triangles see the edge in the same direction: their normals disagree
};

/// Inside one element there is no fold.
Fold find_fold(const geometry::ShellMesh& mesh, const std::vector<Mat3>& frames,
               const geometry::CellContact& contact) {
  const int element_a = mesh.cells[at(contact.cell_a)].element;
  const int element_b = mesh.cells[at(contact.cell_b)].element;
  if (element_a == element_b) return {};
  const geometry::TriangleMesh& whole = mesh.elements->mesh;
  const auto edge_of = [&](int c, int side) {
    const geometry::ShellCell& cell = mesh.cells[at(c)];
    const Size i = at(mesh.corners[at(cell.first_corner + side)].side_id);
    const geometry::Triangle& t = whole.triangles[at(cell.element)];
    return std::array<int, 2>{t[i], t[(i + 1) % 3]};
  };
  const auto ends_a = edge_of(contact.cell_a, contact.side_a);
  const auto ends_b = edge_of(contact.cell_b, contact.side_b);
  const Vec3& origin = whole.positions[at(ends_a[0])];
  const Vec3 along = (whole.positions[at(ends_a[1])] - origin).normalized();
  const auto view = [&](int c, int element) {
    const Mat3& frame = frames[at(c)];
    const Vec3 way = origin - whole.positions[at(whole.triangles[at(element)][0])];
    return FoldSide{{frame.col(0).dot(way), frame.col(1).dot(way)},
                    {frame.col(0).dot(along), frame.col(1).dot(along)}};
  };
  return {view(contact.cell_a, element_a), view(contact.cell_b, element_b), ends_a[0] == ends_b[0]};
}

/// A point of one side's plane, turned about the edge into the other's.
Vec2 unfold(const Vec2& point, const FoldSide& from, const FoldSide& to, bool is_flipped) {
  const auto left_of = [](const Vec2& v) { return Vec2(-v.y(), v.x()); };
  const Vec2 way = point - from.origin;
  // Where normals agree both see the edge from opposite sides, and left stays left; else it changes.
  const double across = (is_flipped ? -1.0 : 1.0) * way.dot(left_of(from.along));
  return to.origin + way.dot(from.along) * to.along + across * left_of(to.along);
}

/// Sums over a cell and its neighbours, for the least squares.
struct Moments {
  double area = 0.0;
  Vec2 first = Vec2::Zero();
  Mat2 second = Mat2::Zero();
  CellStress stress;
  std::array<CellStress, 2> stress_by_place;

  void add(double weight, const Vec2& place, const CellStress& s) {
    area += weight;
    first += weight * place;
    second += weight * place * place.transpose();
    stress.membrane += weight * s.membrane;
    stress.bending += weight * s.bending;
    for (int i = 0; i < 2; ++i) {
      stress_by_place[at(i)].membrane += weight * place(i) * s.membrane;
      stress_by_place[at(i)].bending += weight * place(i) * s.bending;
    }
  }

  LinearStress fit(const CellStress& own) const {
    constexpr double kLeastSpread = 1e-3;  // of the spread along the other axis: hardly more than a line
    LinearStress result;
    result.mean = own;
    if (!(area > 0.0)) return result;
    result.centre = first / area;
    result.mean = {stress.membrane / area, stress.bending / area};
    const Mat2 spread = second / area - result.centre * result.centre.transpose();
    const double determinant = spread(0, 0) * spread(1, 1) - spread(0, 1) * spread(1, 0);
    const double trace = spread(0, 0) + spread(1, 1);
    if (!(determinant > kLeastSpread * trace * trace)) return result;
    Mat2 inverse;
    inverse << spread(1, 1), -spread(0, 1), -spread(1, 0), spread(0, 0);
    inverse /= determinant;
    for (const auto part : {&CellStress::membrane, &CellStress::bending}) {
      const PlaneStress x = stress_by_place[0].*part / area - result.centre.x() * (result.mean.*part);
      const PlaneStress y = stress_by_place[1].*part / area - result.centre.y() * (result.mean.*part);
      result.slope[0].*part = inverse(0, 0) * x + inverse(0, 1) * y;
      result.slope[1].*part = inverse(1, 0) * x + inverse(1, 1) * y;
    }
    return result;
  }
};

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

Vec2 place_in_frame(const geometry::ShellElements& elements, int element, const Mat3& frame,
                    const Vec2& barycentric) {
  const geometry::Triangle& t = elements.mesh.triangles[at(element)];
  const Vec3& origin = elements.mesh.positions[at(t[0])];
  const Vec3 way = barycentric.x() * (elements.mesh.positions[at(t[1])] - origin) +
                   barycentric.y() * (elements.mesh.positions[at(t[2])] - origin);
  return {frame.col(0).dot(way), frame.col(1).dot(way)};
}

CellStress LinearStress::at(const Vec2& place) const {
  const Vec2 way = place - centre;
  return {mean.membrane + way.x() * slope[0].membrane + way.y() * slope[1].membrane,
          mean.bending + way.x() * slope[0].bending + way.y() * slope[1].bending};
}

std::vector<LinearStress> fit_stresses(const geometry::ShellMesh& mesh,
                                       const std::vector<geometry::CellContact>& contacts,
                                       const std::vector<CellStress>& stresses) {
  std::vector<Mat3> frames(mesh.cells.size());
  std::vector<Vec2> centroids(mesh.cells.size());
  core::parallel_for(mesh.cells.size(), 512, [&](Size c) {
    frames[c] = geometry::facet_frame(*mesh.elements, mesh.cells[c].element);
    const Vec3 weights = centroid_weights(mesh, mesh.cells[c]);
    centroids[c] = place_in_frame(*mesh.elements, mesh.cells[c].element, frames[c], weights.tail<2>());
  });
  std::vector<Moments> sums(stresses.size());
  for (Size c = 0; c < stresses.size(); ++c) sums[c].add(mesh.cells[c].area, centroids[c], stresses[c]);
  for (const geometry::CellContact& contact : contacts) {
    const Fold fold = find_fold(mesh, frames, contact);
    const auto carry = [&](int from, const FoldSide& side_from, const FoldSide& side_to) {
      const auto turned = [&](const PlaneStress& stress) {
        PlaneStress edge = turn(stress, side_from.along);
        if (fold.is_flipped) edge(2) = -edge(2);
        return turn_back(edge, side_to.along);
      };
      const CellStress& stress = stresses[at(from)];
      const double sign = fold.is_flipped ? -1.0 : 1.0;
      return CellStress{turned(stress.membrane), sign * turned(stress.bending)};
    };
    const auto add = [&](int to, const FoldSide& side_to, int from, const FoldSide& side_from) {
      sums[at(to)].add(mesh.cells[at(from)].area,
                       unfold(centroids[at(from)], side_from, side_to, fold.is_flipped),
                       carry(from, side_from, side_to));
    };
    add(contact.cell_a, fold.a, contact.cell_b, fold.b);
    add(contact.cell_b, fold.b, contact.cell_a, fold.a);
  }
  std::vector<LinearStress> fits(stresses.size());
  core::parallel_for(fits.size(), 512, [&](Size c) { fits[c] = sums[c].fit(stresses[c]); });
  return fits;
}

std::vector<CellStress> average_stresses(const geometry::ShellMesh& mesh,
                                         const std::vector<geometry::CellContact>& contacts,
                                         const std::vector<CellStress>& stresses) {
  std::vector<CellStress> means;
  means.reserve(stresses.size());
  for (const LinearStress& fit : fit_stresses(mesh, contacts, stresses)) means.push_back(fit.mean);
  return means;
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
