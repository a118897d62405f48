#include "engine/stress/solid_stiffness.h"

#include <algorithm>

#include "engine/core/disjoint_sets.h"
#include "engine/core/elementary.h"
#include "engine/core/index.h"
#include "engine/core/parallel.h"

namespace shatterbox::stress {
namespace {

using Size = std::size_t;
using core::at;

constexpr double kLeastFlatness = 1e-3;  // height over longest edge

SolidElement make_solid_element(const geometry::TetMesh& mesh, const geometry::Tetrahedron& tetrahedron,
                                double length) {
  std::array<Vec3, 4> corners;
  for (Size i = 0; i < 4; ++i)
    corners[i] = (mesh.positions[at(tetrahedron[i])] - mesh.positions[at(tetrahedron[0])]) / length;
  SolidElement element;
  element.gradients.fill(Vec3::Zero());
  element.volume = corners[1].cross(corners[2]).dot(corners[3]) / 6.0;
  double longest_squared = 0.0;
  for (const auto& edge : geometry::kTetrahedronEdges)
    longest_squared = std::max(longest_squared, (corners[at(edge[0])] - corners[at(edge[1])]).squaredNorm());
  const double longest = core::sqrt(longest_squared);
  // Below that the division would leave no digit.
  if (!(element.volume > 1e-15 * longest * longest_squared)) {
    element.volume = std::max(element.volume, 0.0);
    element.modulus = 0.0;
    return element;
  }
  double steepest_squared = 0.0;
  for (Size i = 0; i < 4; ++i) {
    const auto& face = geometry::kTetrahedronFaces[i];
    const Vec3& a = corners[at(face[0])];
    // Twice the area, inwards; over three times the volume it is one over the height.
    const Vec3 inwards = (corners[at(face[2])] - a).cross(corners[at(face[1])] - a);
    element.gradients[i] = inwards / (6.0 * element.volume);
    steepest_squared = std::max(steepest_squared, element.gradients[i].squaredNorm());
  }
  // Stiffness is area over height.
  const double flatness = 1.0 / (core::sqrt(steepest_squared) * longest);
  element.modulus = std::min(1.0, flatness / kLeastFlatness);
  return element;
}

double bounding_diagonal_of(const geometry::TetMesh& mesh) {
  if (mesh.tetrahedra.empty()) return 1.0;
  Vec3 low = mesh.positions[at(mesh.tetrahedra.front()[0])];
  Vec3 high = low;
  for (const geometry::Tetrahedron& tetrahedron : mesh.tetrahedra)
    for (const int vertex : tetrahedron) {
      low = low.cwiseMin(mesh.positions[at(vertex)]);
      high = high.cwiseMax(mesh.positions[at(vertex)]);
    }
  const double diagonal = core::sqrt((high - low).squaredNorm());
  return diagonal > 0.0 ? diagonal : 1.0;
}

}  // namespace

std::shared_ptr<const SolidStiffness> make_solid_stiffness(
    std::shared_ptr<const geometry::SolidElements> elements, const SolidProperties& properties) {
  auto result = std::make_shared<SolidStiffness>();
  result->elements = std::move(elements);
  result->properties = properties;
  result->poisson_ratio = std::min(properties.poisson_ratio, kMostPoissonRatio);
  const geometry::TetMesh& mesh = result->elements->mesh;
  result->length = bounding_diagonal_of(mesh);
  result->solids.resize(mesh.tetrahedra.size());
  core::parallel_for(mesh.tetrahedra.size(), 1024, [&](Size t) {
    result->solids[t] = make_solid_element(mesh, mesh.tetrahedra[t], result->length);
  });
  return result;
}

double stiffness_fraction(const SolidStiffness& stiffness, const geometry::SolidCell& cell) {
  const double length = stiffness.length;
  const double whole = stiffness.solids[at(cell.element)].volume * (length * length * length);
  if (!(whole > 0.0)) return 1.0;
  return std::clamp(cell.volume / whole, kLeastVolumeFraction, 1.0);
}

Eigen::Vector4d centroid_weights(const geometry::SolidCell& cell) {
  constexpr double kLeast = 1e-3;
  const Vec3& c = cell.centroid;
  const Eigen::Vector4d weights(1.0 - c.x() - c.y() - c.z(), c.x(), c.y(), c.z());
  const Eigen::Vector4d clamped = weights.cwiseMax(kLeast);
  return clamped / clamped.sum();
}

VecX apply_stiffness(const SolidStiffness& stiffness, const geometry::SolidMesh& mesh,
                     const VecX& displacement) {
  VecX result = VecX::Zero(displacement.size());
  const double lambda = stiffness.lame_lambda(), mu = stiffness.lame_mu();
  for (const geometry::SolidCell& cell : mesh.cells) {
    const SolidElement& element = stiffness.solids[at(cell.element)];
    Mat3 gradient = Mat3::Zero();  // of the displacement
    for (Size i = 0; i < 4; ++i)
      gradient +=
          displacement.segment<3>(3 * cell.vertices[i]) / stiffness.length * element.gradients[i].transpose();
    const Mat3 stress = element.modulus * (mu * (gradient + gradient.transpose()) +
                                           lambda * gradient.trace() * Mat3::Identity());
    const double factor = stiffness.force_unit() * element.volume * stiffness_fraction(stiffness, cell);
    for (Size i = 0; i < 4; ++i)
      result.segment<3>(3 * cell.vertices[i]) += factor * (stress * element.gradients[i]);
  }
  return result;
}

VecX lumped_mass(const SolidStiffness& stiffness, const geometry::SolidMesh& mesh) {
  constexpr double kLeastShare = 1e-9;  // of an element: a cell may be narrower than the cutter's rounding
  VecX mass = VecX::Zero(mesh.degree_of_freedom_count());
  const double unit = stiffness.length * stiffness.length * stiffness.length;
  for (const geometry::SolidCell& cell : mesh.cells) {
    const Eigen::Vector4d weights = centroid_weights(cell);
    const double volume =
        std::max(cell.volume, kLeastShare * stiffness.solids[at(cell.element)].volume * unit);
    for (int i = 0; i < 4; ++i)
      mass.segment<3>(3 * cell.vertices[at(i)]).array() += stiffness.properties.density * volume * weights(i);
  }
  return mass;
}

std::vector<int> part_of_dofs(const geometry::SolidMesh& mesh) {
  core::DisjointSets parts(mesh.vertex_source.size());
  std::vector<char> is_used(mesh.vertex_source.size(), 0);
  for (const geometry::SolidCell& cell : mesh.cells)
    for (const int vertex : cell.vertices) {
      parts.unite(vertex, cell.vertices[0]);
      is_used[at(vertex)] = 1;
    }
  std::vector<int> part_of(at(mesh.degree_of_freedom_count()), -1);
  std::vector<int> number(is_used.size(), -1);
  int count = 0;
  for (int v = 0; v < static_cast<int>(is_used.size()); ++v) {
    if (is_used[at(v)] == 0) continue;
    int& part = number[at(parts.find(v))];
    if (part < 0) part = count++;
    for (int axis = 0; axis < 3; ++axis) part_of[at(3 * v + axis)] = part;
  }
  return part_of;
}

}  // namespace shatterbox::stress
