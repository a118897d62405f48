#include "engine/geometry/tet_quality.h"

#include <algorithm>
#include <limits>
#include <vector>

#include "engine/core/elementary.h"
#include "engine/core/index.h"

namespace shatterbox::geometry {
namespace {

using Size = std::size_t;
using core::at;

/// The value that a share of all is not greater than.
double quantile(std::vector<double>& values, double share) {
  const auto place = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + place, values.end());
  return values[static_cast<Size>(place)];
}

}  // namespace

TetShape tetrahedron_shape(const std::array<Vec3, 4>& corners) {
  TetShape shape;
  std::array<Vec3, 4> normals;  // outward, twice the face's area long
  double greatest_area = 0.0;
  for (Size f = 0; f < 4; ++f) {
    const auto& face = kTetrahedronFaces[f];
    const Vec3& a = corners[at(face[0])];
    normals[f] = (corners[at(face[1])] - a).cross(corners[at(face[2])] - a);
    greatest_area = std::max(greatest_area, normals[f].norm());
  }
  double longest_squared = 0.0;
  for (Size e = 0; e < 6; ++e) {
    const auto& [i, j] = kTetrahedronEdges[e];
    longest_squared = std::max(longest_squared, (corners[at(j)] - corners[at(i)]).squaredNorm());
    // The faces on an edge are those opposite to the two other corners.
    const auto& [k, l] = kTetrahedronEdges[5 - e];
    const Vec3& m = normals[at(k)];
    const Vec3& n = normals[at(l)];
    shape.dihedrals[e] = core::atan2(m.cross(n).norm(), -m.dot(n));
  }
  const double six_volumes =
      (corners[1] - corners[0]).cross(corners[2] - corners[0]).dot(corners[3] - corners[0]);
  shape.aspect = six_volumes > 0.0 ? core::sqrt(longest_squared) * greatest_area / six_volumes
                                   : std::numeric_limits<double>::max();
  return shape;
}

TetQuality measure_quality(const TetMesh& mesh) {
  TetQuality quality;
  quality.count = static_cast<int>(mesh.tetrahedra.size());
  if (quality.count == 0) return quality;
  quality.least_volume = std::numeric_limits<double>::max();
  quality.least_dihedral = core::kPi;
  std::vector<double> least_dihedrals, aspects;
  for (int t = 0; t < quality.count; ++t) {
    std::array<Vec3, 4> corners;
    for (Size k = 0; k < 4; ++k) corners[k] = mesh.positions[at(mesh.tetrahedra[at(t)][k])];
    const TetShape shape = tetrahedron_shape(corners);
    const auto [least, greatest] = std::minmax_element(shape.dihedrals.begin(), shape.dihedrals.end());
    least_dihedrals.push_back(*least);
    aspects.push_back(shape.aspect);
    quality.least_dihedral = std::min(quality.least_dihedral, *least);
    quality.greatest_dihedral = std::max(quality.greatest_dihedral, *greatest);
    quality.worst_aspect = std::max(quality.worst_aspect, shape.aspect);
    for (const double angle : shape.dihedrals)
      ++quality.dihedral_histogram[std::min(Size{17}, static_cast<Size>(angle / core::kPi * 18.0))];
    for (const auto& [i, j] : kTetrahedronEdges)
      quality.mean_edge_length += (corners[at(j)] - corners[at(i)]).norm() / (6.0 * quality.count);
    const double volume = tetrahedron_volume(mesh, t);
    quality.volume += volume;
    quality.least_volume = std::min(quality.least_volume, volume);
  }
  quality.hundredth_dihedral = quantile(least_dihedrals, 0.01);
  quality.median_least_dihedral = quantile(least_dihedrals, 0.5);
  quality.median_aspect = quantile(aspects, 0.5);
  return quality;
}

}  // namespace shatterbox::geometry
