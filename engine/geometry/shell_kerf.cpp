#include "engine/geometry/shell_kerf.h"

#include <algorithm>

#include "engine/core/index.h"

namespace shatterbox::geometry {
namespace {

using Size = std::size_t;
using core::at;

constexpr double kFlat = 1e-7;           // rad: planes that differ by less are one
constexpr double kMitreSoftness = 0.02;  // bounds how far a sharp corner retreats along its bisector
constexpr double kLeastAreaKept = 0.4;   // of a triangle, after the kerf
constexpr int kMovingRounds = 3;         // rounds in which vertices near a crack move along with it
constexpr int kHalvingRounds = 10;       // rounds in which a kerf that is still too wide is halved

/// Where a vertex may go without leaving the planes of its triangles.
class Freedom {
 public:
  void stay_in_plane(const Vec3& normal) {
    if (planes_ == 0) {
      vector_ = normal;
      planes_ = 1;
    } else if (planes_ == 1) {
      const Vec3 fold = vector_.cross(normal);
      if (fold.squaredNorm() < kFlat * kFlat) return;
      vector_ = fold.normalized();
      planes_ = 2;
    } else if (planes_ == 2 && std::abs(vector_.dot(normal)) > kFlat) {
      planes_ = 3;
    }
  }
  bool is_fold() const { return planes_ == 2; }
  bool is_corner() const { return planes_ == 3; }
  const Vec3& fold() const { return vector_; }
  /// What is left of a shift.
  Vec3 allowed(const Vec3& shift) const {
    if (is_corner()) return Vec3::Zero();
    return is_fold() ? Vec3(shift.dot(vector_) * vector_) : shift;
  }

 private:
  int planes_ = 0;              // that differ, at most 3
  Vec3 vector_ = Vec3::Zero();  // of one plane the normal, of two their common line
};

std::vector<Freedom> find_freedoms(const TriangleMesh& mesh, const std::vector<Vec3>& triangle_normals) {
  std::vector<Freedom> freedoms(mesh.positions.size());
  for (Size t = 0; t < mesh.triangles.size(); ++t)
    for (const int v : mesh.triangles[t]) freedoms[at(v)].stay_in_plane(triangle_normals[t]);
  return freedoms;
}

/// The retreat of one vertex from all its crack faces, along the rim where it lies on one; zero at a tip.
Vec3 retreat(const BorderNormal* first, const BorderNormal* last, const Freedom& freedom, double kerf) {
  if (freedom.is_corner()) return Vec3::Zero();
  Mat3 matrix = kMitreSoftness * Mat3::Identity();
  Vec3 right = Vec3::Zero();
  for (const BorderNormal* n = first; n != last; ++n) {
    for (const BorderNormal* m = n + 1; m != last; ++m)
      if (n->is_crack && m->is_crack && n->element == m->element && n->side_id == m->side_id &&
          n->inward.dot(m->inward) < -0.5)
        return Vec3::Zero();  // both lips of one cut meet here
    matrix += n->inward * n->inward.transpose();
    if (n->is_crack) right += kerf * n->inward;
  }
  if (freedom.is_fold())
    return freedom.fold().dot(right) / freedom.fold().dot(matrix * freedom.fold()) * freedom.fold();
  return matrix.inverse() * right;
}

std::vector<int> collapsed(const TriangleMesh& mesh, const std::vector<Vec3>& shift) {
  std::vector<int> bad;
  const std::vector<Vec3>& x = mesh.positions;
  for (Size t = 0; t < mesh.triangles.size(); ++t) {
    const auto [i, j, k] = mesh.triangles[t];
    if (shift[at(i)].isZero(0.0) && shift[at(j)].isZero(0.0) && shift[at(k)].isZero(0.0)) continue;
    const Vec3 before = (x[at(j)] - x[at(i)]).cross(x[at(k)] - x[at(i)]);
    const Vec3 after = (x[at(j)] + shift[at(j)] - x[at(i)] - shift[at(i)])
                           .cross(x[at(k)] + shift[at(k)] - x[at(i)] - shift[at(i)]);
    if (!(after.dot(before) >= kLeastAreaKept * before.squaredNorm())) bad.push_back(static_cast<int>(t));
  }
  return bad;
}

/// Keeps every triangle's orientation and at least kLeastAreaKept of its area. Vertices inside first move
/// along with the crack, so that slivers beside it do not narrow the kerf; what still does not fit is
/// halved.
void limit(const TriangleMesh& mesh, const std::vector<char>& is_border, const std::vector<Freedom>& freedoms,
           std::vector<Vec3>& shift) {
  std::vector<int> bad = collapsed(mesh, shift);
  for (int round = 0; round < kMovingRounds + kHalvingRounds && !bad.empty(); ++round) {
    for (const int t : bad) {
      const Triangle& triangle = mesh.triangles[at(t)];
      if (round >= kMovingRounds) {
        for (const int v : triangle) shift[at(v)] *= round + 1 < kMovingRounds + kHalvingRounds ? 0.5 : 0.0;
        continue;
      }
      Vec3 largest = Vec3::Zero();
      for (const int v : triangle)
        if (shift[at(v)].squaredNorm() > largest.squaredNorm()) largest = shift[at(v)];
      for (const int v : triangle)
        if (!is_border[at(v)] && shift[at(v)].squaredNorm() < largest.squaredNorm())
          shift[at(v)] = freedoms[at(v)].allowed(largest);
    }
    bad = collapsed(mesh, shift);
  }
  // The last resort: the vertices of a triangle that still collapses stay where they were, and so do those
  // around it.
  for (int round = 0; round < 100 && !bad.empty(); ++round) {
    for (const int t : bad)
      for (const int v : mesh.triangles[at(t)]) shift[at(v)].setZero();
    bad = collapsed(mesh, shift);
  }
}

/// The narrowest stand-off of a crack vertex that is not a tip.
double least_kerf_of(const std::vector<BorderNormal>& normals, const std::vector<Freedom>& freedoms,
                     const std::vector<Vec3>& shift, double kerf) {
  double least = kerf;
  for (Size n = 0; n < normals.size(); ++n) {
    if (!normals[n].is_crack) continue;
    Size first = n;
    while (first > 0 && normals[first - 1].vertex == normals[n].vertex) --first;
    Size last = n + 1;
    while (last < normals.size() && normals[last].vertex == normals[n].vertex) ++last;
    const Freedom& freedom = freedoms[at(normals[n].vertex)];
    if (retreat(normals.data() + first, normals.data() + last, freedom, kerf).isZero(0.0)) continue;  // a tip
    least = std::min(least, shift[at(normals[n].vertex)].dot(normals[n].inward));
  }
  return std::max(least, 0.0);
}

}  // namespace

double stand_back(TriangleMesh& mesh, const std::vector<Vec3>& triangle_normals,
                  const std::vector<BorderNormal>& normals, double kerf) {
  const std::vector<Freedom> freedoms = find_freedoms(mesh, triangle_normals);
  std::vector<Vec3> shift(mesh.positions.size(), Vec3::Zero());
  std::vector<char> is_border(mesh.positions.size(), 0);
  for (Size first = 0; first < normals.size();) {
    Size last = first;
    bool has_crack = false;
    for (; last < normals.size() && normals[last].vertex == normals[first].vertex; ++last)
      has_crack = has_crack || normals[last].is_crack;
    is_border[at(normals[first].vertex)] = 1;
    if (has_crack)
      shift[at(normals[first].vertex)] =
          retreat(normals.data() + first, normals.data() + last, freedoms[at(normals[first].vertex)], kerf);
    first = last;
  }
  limit(mesh, is_border, freedoms, shift);
  for (Size v = 0; v < shift.size(); ++v) mesh.positions[v] += shift[v];
  return least_kerf_of(normals, freedoms, shift, kerf);
}

}  // namespace shatterbox::geometry
