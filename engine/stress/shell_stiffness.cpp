#include "engine/stress/shell_stiffness.h"

#include <algorithm>

#include "engine/core/elementary.h"
#include "engine/core/index.h"
#include "engine/core/parallel.h"
#include "engine/stress/elimination_order.h"

namespace shatterbox::stress {
namespace {

using Size = std::size_t;
using Strain = Eigen::Matrix<double, 6, kElementDofs, Eigen::RowMajor>;

using core::at;

/// Corners of an element in its own plane, in units of the shell.
std::array<Vec2, 3> flatten(const geometry::ShellElements& elements, int element, const Mat3& frame,
                            double length) {
  const geometry::Triangle& triangle = elements.mesh.triangles[at(element)];
  const Vec3& origin = elements.mesh.positions[at(triangle[0])];
  std::array<Vec2, 3> flat;
  for (Size i = 0; i < 3; ++i) {
    const Vec3 offset = (elements.mesh.positions[at(triangle[i])] - origin) / length;
    flat[i] = Vec2(frame.col(0).dot(offset), frame.col(1).dot(offset));
  }
  return flat;
}

/// Rows 0 to 2: the strain of a linear displacement.
void set_membrane_strain(const std::array<Vec2, 3>& flat, double area, const Mat3& frame, Strain& strain) {
  for (Size i = 0; i < 3; ++i) {
    const Vec2 opposite = flat[(i + 2) % 3] - flat[(i + 1) % 3];
    const Vec2 gradient = Vec2(-opposite.y(), opposite.x()) / (2.0 * area);
    const Eigen::Index column = static_cast<Eigen::Index>(3 * i);
    strain.block<1, 3>(0, column) = gradient.x() * frame.col(0).transpose();
    strain.block<1, 3>(1, column) = gradient.y() * frame.col(1).transpose();
    strain.block<1, 3>(2, column) =
        gradient.y() * frame.col(0).transpose() + gradient.x() * frame.col(1).transpose();
  }
}

/// Rows 3 to 5: Morley's constant curvature -grad grad w, by the divergence theorem from the slope along each
/// edge (the difference of its ends) and across it (its rotation).
void set_bending_strain(const std::array<Vec2, 3>& flat, double area, const Mat3& frame,
                        const geometry::Triangle& triangle, Strain& strain) {
  for (Size i = 0; i < 3; ++i) {
    const Size j = (i + 1) % 3;
    const Vec2 edge = flat[j] - flat[i];
    const double length = edge.norm();
    const Vec2 t = edge / length;
    const Vec2 nu(t.y(), -t.x());  // outwards
    const Vec3 along = Vec3(t.x() * nu.x(), t.y() * nu.y(), t.x() * nu.y() + t.y() * nu.x()) / area;
    const Vec3 across = Vec3(nu.x() * nu.x(), nu.y() * nu.y(), 2.0 * nu.x() * nu.y()) * (length / area);
    for (Eigen::Index row = 0; row < 3; ++row) {
      const Eigen::Index ci = static_cast<Eigen::Index>(3 * i);
      const Eigen::Index cj = static_cast<Eigen::Index>(3 * j);
      strain.block<1, 3>(3 + row, cj) -= along(row) * frame.col(2).transpose();
      strain.block<1, 3>(3 + row, ci) += along(row) * frame.col(2).transpose();
      // The slope across is minus the rotation about the counter-clockwise edge.
      const double sign = triangle[i] < triangle[j] ? 1.0 : -1.0;
      strain(3 + row, 9 + static_cast<Eigen::Index>(i)) = sign * across(row);
    }
  }
}

ElementMatrices make_element(const geometry::ShellElements& elements, int element,
                             const ShellProperties& properties, double length) {
  ElementMatrices result;
  result.strain.setZero();
  result.stiffness.fill(0.0);
  const double area = geometry::element_area(elements, element) / (length * length);
  if (!(area > 0.0)) return result;
  const Mat3 frame = geometry::facet_frame(elements, element);
  const std::array<Vec2, 3> flat = flatten(elements, element, frame, length);
  set_membrane_strain(flat, area, frame, result.strain);
  if (properties.has_bending)
    set_bending_strain(flat, area, frame, elements.mesh.triangles[at(element)], result.strain);

  const double nu = properties.poisson_ratio;
  const double thickness = properties.thickness / length;
  const double membrane = area / (1.0 - nu * nu);
  Strain stress = result.strain;  // C times strain, weighted
  for (Eigen::Index block = 0; block < 6; block += 3) {
    const double factor = block == 0 ? membrane : membrane * thickness * thickness / 12.0;
    stress.row(block) = factor * (result.strain.row(block) + nu * result.strain.row(block + 1));
    stress.row(block + 1) = factor * (result.strain.row(block + 1) + nu * result.strain.row(block));
    stress.row(block + 2) = factor * 0.5 * (1.0 - nu) * result.strain.row(block + 2);
  }
  const Eigen::Matrix<double, kElementDofs, kElementDofs> full = result.strain.transpose() * stress;
  Size entry = 0;
  for (Eigen::Index column = 0; column < kElementDofs; ++column)
    for (Eigen::Index row = column; row < kElementDofs; ++row) result.stiffness[entry++] = full(row, column);
  return result;
}

double bounding_diagonal(const geometry::TriangleMesh& mesh) {
  if (mesh.triangles.empty()) return 1.0;
  Vec3 low = mesh.positions[at(mesh.triangles.front()[0])];
  Vec3 high = low;
  for (const geometry::Triangle& triangle : mesh.triangles)
    for (const int vertex : triangle) {
      low = low.cwiseMin(mesh.positions[at(vertex)]);
      high = high.cwiseMax(mesh.positions[at(vertex)]);
    }
  return core::sqrt((high - low).squaredNorm());
}

}  // namespace

Vec3 centroid_weights(const geometry::ShellMesh& mesh, const geometry::ShellCell& cell) {
  Vec2 sum = Vec2::Zero();
  double twice_area = 0.0;
  const Vec2 origin = mesh.corners[at(cell.first_corner)].barycentric;
  for (int i = 1; i + 1 < cell.corner_count; ++i) {
    const Vec2 a = mesh.corners[at(cell.first_corner + i)].barycentric - origin;
    const Vec2 b = mesh.corners[at(cell.first_corner + i + 1)].barycentric - origin;
    const double part = a.x() * b.y() - a.y() * b.x();
    twice_area += part;
    sum += part * (a + b) / 3.0;
  }
  Vec2 centre = origin;
  if (twice_area > 0.0) centre += sum / twice_area;
  // No degree of freedom may be without mass, whatever the sliver.
  constexpr double kLeast = 1e-3;
  Vec3 weights(1.0 - centre.x() - centre.y(), centre.x(), centre.y());
  weights = weights.cwiseMax(kLeast);
  return weights / weights.sum();
}

std::shared_ptr<const ShellStiffness> make_shell_stiffness(
    std::shared_ptr<const geometry::ShellElements> elements, const ShellProperties& properties,
    std::vector<int> vertex_rank) {
  auto result = std::make_shared<ShellStiffness>();
  result->elements = std::move(elements);
  result->properties = properties;
  const geometry::ShellElements& source = *result->elements;
  result->length = bounding_diagonal(source.mesh);
  result->relative_thickness = properties.thickness / result->length;
  result->matrices.resize(source.mesh.triangles.size());
  core::parallel_for(source.mesh.triangles.size(), 256, [&](Size element) {
    result->matrices[element] = make_element(source, static_cast<int>(element), properties, result->length);
  });
  result->vertex_rank = vertex_rank.empty() ? rank_vertices(source) : std::move(vertex_rank);
  return result;
}

std::array<int, kElementDofs> cell_dofs(const geometry::ShellMesh& mesh, const geometry::ShellCell& cell) {
  std::array<int, kElementDofs> dofs{};
  for (Size i = 0; i < 3; ++i) {
    for (Size axis = 0; axis < 3; ++axis)
      dofs[3 * i + axis] = vertex_dof(cell.vertices[i]) + static_cast<int>(axis);
    dofs[9 + i] = edge_dof(mesh, cell.edges[i]);
  }
  return dofs;
}

double stiffness_fraction(const geometry::ShellElements& elements, const geometry::ShellCell& cell) {
  const double whole = geometry::element_area(elements, cell.element);
  if (!(whole > 0.0)) return 1.0;
  return std::clamp(cell.area / whole, kLeastAreaFraction, 1.0);
}

VecX apply_stiffness(const ShellStiffness& stiffness, const geometry::ShellMesh& mesh,
                     const VecX& displacement) {
  VecX result = VecX::Zero(displacement.size());
  const double force = stiffness.force_unit();
  for (const geometry::ShellCell& cell : mesh.cells) {
    const std::array<int, kElementDofs> dofs = cell_dofs(mesh, cell);
    const auto& matrix = stiffness.matrices[at(cell.element)].stiffness;
    const double factor = force * stiffness_fraction(*stiffness.elements, cell);
    std::array<double, kElementDofs> u{};
    std::array<double, kElementDofs> f{};
    for (Size i = 0; i < kElementDofs; ++i) u[i] = displacement(dofs[i]) / (i < 9 ? stiffness.length : 1.0);
    Size entry = 0;
    for (Size column = 0; column < kElementDofs; ++column)
      for (Size row = column; row < kElementDofs; ++row, ++entry) {
        f[row] += matrix[entry] * u[column];
        if (row != column) f[column] += matrix[entry] * u[row];
      }
    for (Size i = 0; i < kElementDofs; ++i)
      result(dofs[i]) += factor * f[i] * (i < 9 ? 1.0 : stiffness.length);
  }
  return result;
}

VecX lumped_mass(const ShellStiffness& stiffness, const geometry::ShellMesh& mesh) {
  VecX mass = VecX::Zero(mesh.degree_of_freedom_count());
  const double thickness = stiffness.properties.thickness;
  const double per_area = stiffness.properties.density * thickness;
  for (const geometry::ShellCell& cell : mesh.cells) {
    const Vec3 weights = centroid_weights(mesh, cell);
    for (int i = 0; i < 3; ++i) {
      const int first = vertex_dof(cell.vertices[at(i)]);
      for (int axis = 0; axis < 3; ++axis) mass(first + axis) += per_area * cell.area * weights(i);
      mass(edge_dof(mesh, cell.edges[at(i)])) += per_area * thickness * thickness / 12.0 * cell.area / 3.0;
    }
  }
  return mass;
}

}  // namespace shatterbox::stress
