#include "engine/stress/solid_stress.h"

#include <algorithm>

#include "engine/core/elementary.h"
#include "engine/core/index.h"
#include "engine/core/parallel.h"

namespace shatterbox::stress {
namespace {

using Size = std::size_t;
using core::at;

/// A cell's volume as a weight: what is narrower than the cutter's rounding may have less than none.
double weight_of(const geometry::SolidMesh& mesh, Size cell) {
  return std::max(0.0, mesh.cells[cell].volume);
}

/// Sums over a cell and its neighbours, for the least squares. Places relative to the cell's own centroid.
struct SolidMoments {
  double volume = 0.0;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();
  SolidStress stress = SolidStress::Zero();
  std::array<SolidStress, 3> stress_by_place{SolidStress::Zero(), SolidStress::Zero(), SolidStress::Zero()};

  void add(double weight, const Vec3& place, const SolidStress& s) {
    volume += weight;
    first += weight * place;
    second += weight * place * place.transpose();
    stress += weight * s;
    for (int i = 0; i < 3; ++i) stress_by_place[at(i)] += weight * place(i) * s;
  }

  LinearSolidStress fit(const SolidStress& own, const Vec3& origin) const {
    constexpr double kLeastSpread = 1e-4;  // of the cube of the mean spread: hardly more than a plane
    LinearSolidStress result;
    result.mean = own;
    result.centre = origin;
    if (!(volume > 0.0)) return result;
    const Vec3 centre = first / volume;
    result.centre = origin + centre;
    result.mean = stress / volume;
    const Mat3 spread = second / volume - centre * centre.transpose();
    const double mean_spread = spread.trace() / 3.0;
    if (!(mean_spread > 0.0)) return result;
    const Mat3 relative = spread / mean_spread;
    if (!(relative.determinant() > kLeastSpread)) return result;
    const Mat3 inverse = relative.inverse() / mean_spread;
    std::array<SolidStress, 3> moment;
    for (int i = 0; i < 3; ++i) moment[at(i)] = stress_by_place[at(i)] / volume - centre(i) * result.mean;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) result.slope[at(i)] += inverse(i, j) * moment[at(j)];
    return result;
  }
};

}  // namespace

Mat3 stress_tensor(const SolidStress& s) {
  Mat3 tensor;
  tensor << s(0), s(5), s(4), s(5), s(1), s(3), s(4), s(3), s(2);
  return tensor;
}

PrincipalAxes principal_axes(const SolidStress& stress) {
  return find_principal_axes(stress_tensor(stress));
}

double von_mises(const SolidStress& s) {
  const double xy = s(0) - s(1), yz = s(1) - s(2), zx = s(2) - s(0);
  return core::sqrt(0.5 * (xy * xy + yz * yz + zx * zx) + 3.0 * (s(3) * s(3) + s(4) * s(4) + s(5) * s(5)));
}

double most_tension(const SolidStress& s) {
  constexpr double kAboveRounding = 1.0 + 1e-12;
  const double mean = (s(0) + s(1) + s(2)) / 3.0;
  return mean + kAboveRounding * (2.0 / 3.0 * von_mises(s) + 1e-12 * std::abs(mean));
}

double stress_norm(const SolidStress& s) {
  return core::sqrt(s(0) * s(0) + s(1) * s(1) + s(2) * s(2) +
                    2.0 * (s(3) * s(3) + s(4) * s(4) + s(5) * s(5)));
}

std::vector<SolidStress> cell_stresses(const SolidStiffness& stiffness, const geometry::SolidMesh& mesh,
                                       const VecX& displacement) {
  const double lambda = stiffness.properties.youngs_modulus * stiffness.lame_lambda();
  const double mu = stiffness.properties.youngs_modulus * stiffness.lame_mu();
  std::vector<SolidStress> stresses(mesh.cells.size());
  core::parallel_for(mesh.cells.size(), 2048, [&](Size c) {
    const geometry::SolidCell& cell = mesh.cells[c];
    const SolidElement& element = stiffness.solids[at(cell.element)];
    Mat3 gradient = Mat3::Zero();
    for (Size i = 0; i < 4; ++i)
      gradient += displacement.segment<3>(3 * cell.vertices[i]) * element.gradients[i].transpose();
    gradient *= element.modulus / stiffness.length;
    const double pressure = lambda * gradient.trace();
    stresses[c] << 2.0 * mu * gradient(0, 0) + pressure, 2.0 * mu * gradient(1, 1) + pressure,
        2.0 * mu * gradient(2, 2) + pressure, mu * (gradient(1, 2) + gradient(2, 1)),
        mu * (gradient(2, 0) + gradient(0, 2)), mu * (gradient(0, 1) + gradient(1, 0));
  });
  return stresses;
}

Vec3 cell_centroid(const geometry::SolidMesh& mesh, const geometry::SolidCell& cell) {
  const geometry::Tetrahedron& t = mesh.elements->mesh.tetrahedra[at(cell.element)];
  const auto& positions = mesh.elements->mesh.positions;
  const Vec3& a = positions[at(t[0])];
  Vec3 centroid = a;
  for (int i = 0; i < 3; ++i) centroid += cell.centroid(i) * (positions[at(t[at(i + 1)])] - a);
  return centroid;
}

std::vector<LinearSolidStress> fit_stresses(const geometry::SolidMesh& mesh,
                                            const std::vector<geometry::SolidContact>& contacts,
                                            const std::vector<SolidStress>& stresses) {
  std::vector<Vec3> centroids(mesh.cells.size());
  for (Size c = 0; c < centroids.size(); ++c) centroids[c] = cell_centroid(mesh, mesh.cells[c]);
  std::vector<SolidMoments> sums(stresses.size());
  for (Size c = 0; c < stresses.size(); ++c) sums[c].add(weight_of(mesh, c), Vec3::Zero(), stresses[c]);
  for (const geometry::SolidContact& contact : contacts) {
    const Size a = at(contact.cell_a), b = at(contact.cell_b);
    sums[a].add(weight_of(mesh, b), centroids[b] - centroids[a], stresses[b]);
    sums[b].add(weight_of(mesh, a), centroids[a] - centroids[b], stresses[a]);
  }
  std::vector<LinearSolidStress> fits(stresses.size());
  core::parallel_for(fits.size(), 2048, [&](Size c) { fits[c] = sums[c].fit(stresses[c], centroids[c]); });
  return fits;
}

SolidStress LinearSolidStress::at(const Vec3& place) const {
  const Vec3 way = place - centre;
  return mean + way.x() * slope[0] + way.y() * slope[1] + way.z() * slope[2];
}

std::vector<SolidStress> average_stresses(const geometry::SolidMesh& mesh,
                                          const std::vector<geometry::SolidContact>& contacts,
                                          const std::vector<SolidStress>& stresses) {
  std::vector<double> volumes(stresses.size());
  std::vector<SolidStress> means(stresses.size());
  const auto add = [&](Size to, Size from) {
    volumes[to] += weight_of(mesh, from);
    means[to] += weight_of(mesh, from) * stresses[from];
  };
  for (Size c = 0; c < stresses.size(); ++c) {
    means[c].setZero();
    add(c, c);
  }
  for (const geometry::SolidContact& contact : contacts) {
    add(at(contact.cell_a), at(contact.cell_b));
    add(at(contact.cell_b), at(contact.cell_a));
  }
  for (Size c = 0; c < stresses.size(); ++c) {
    if (volumes[c] > 0.0)
      means[c] /= volumes[c];
    else
      means[c] = stresses[c];
  }
  return means;
}

std::vector<SolidStress> combine_stresses(const std::vector<std::vector<SolidStress>>& stresses,
                                          const std::vector<double>& factors) {
  std::vector<SolidStress> result(stresses.empty() ? 0 : stresses.front().size(), SolidStress::Zero());
  for (Size i = 0; i < stresses.size(); ++i)
    for (Size c = 0; c < result.size(); ++c) result[c] += factors[i] * stresses[i][c];
  return result;
}

}  // namespace shatterbox::stress
