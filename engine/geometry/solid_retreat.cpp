#include "engine/geometry/solid_retreat.h"

#include <algorithm>
#include <optional>

#include "engine/core/index.h"

namespace shatterbox::geometry {
namespace {

using Size = std::size_t;
using core::at;

constexpr double kSameCrack = 0.014;     // sine: crack faces that turn by less are one
constexpr double kSameOuter = 1e-6;      // sine: likewise outer ones
constexpr double kSameFace = 0.87;       // cosine: outer faces that turn by less are one curved one
constexpr double kLongestRetreat = 4.0;  // kerfs: how far a sharp corner retreats along its bisector
constexpr double kRounding = 1e-9;       // kerfs: a plane that a shift comes before by less is kept to

/// normal . shift <= bound, or equal to it.
struct Plane {
  Vec3 normal;  // unit, outward
  double bound;
  bool is_equality;
};

/// The shortest shift that keeps to all planes; nothing if there is none. It is the point nearest to zero
/// that some planes (at most three) have in common, so all such points are tried.
class ShortestShift {
 public:
  ShortestShift(const std::vector<Plane>& planes, double tolerance)
      : planes_(planes), tolerance_(tolerance) {}

  std::optional<Vec3> find() {
    consider(Vec3::Zero());
    const Size n = planes_.size();
    for (Size i = 0; i < n; ++i) {
      consider(planes_[i].bound * planes_[i].normal);
      for (Size j = i + 1; j < n; ++j) {
        const Vec3 along = planes_[i].normal.cross(planes_[j].normal);
        const double squared = along.squaredNorm();
        if (squared < kParallel) continue;
        const Vec3 on_both = (planes_[i].bound * planes_[j].normal.cross(along) -
                              planes_[j].bound * planes_[i].normal.cross(along)) /
                             squared;
        consider(on_both);
        for (Size k = j + 1; k < n; ++k) {
          const double steepness = planes_[k].normal.dot(along);
          if (steepness * steepness < kParallel) continue;
          consider(on_both + (planes_[k].bound - planes_[k].normal.dot(on_both)) / steepness * along);
        }
      }
    }
    return best_;
  }

 private:
  static constexpr double kParallel = 1e-14;  // squared sine

  void consider(const Vec3& shift) {
    const double squared = shift.squaredNorm();
    if (best_ && squared >= least_) return;
    for (const Plane& plane : planes_) {
      const double beyond = plane.normal.dot(shift) - plane.bound;
      if (beyond > tolerance_ || (plane.is_equality && beyond < -tolerance_)) return;
    }
    best_ = shift;
    least_ = squared;
  }

  const std::vector<Plane>& planes_;
  const double tolerance_;
  double least_ = 0.0;
  std::optional<Vec3> best_;
};

void add_normal(std::vector<Vec3>& normals, const Vec3& normal, double same) {
  for (const Vec3& n : normals)
    if ((n - normal).squaredNorm() < same * same) return;
  normals.push_back(normal);
}

}  // namespace

void add_normal(std::vector<Vec3>& cracks, std::vector<Vec3>& outers, bool is_crack, const Vec3& normal) {
  add_normal(is_crack ? cracks : outers, normal, is_crack ? kSameCrack : kSameOuter);
}

bool stands_back(const SolidSurface& surface, int triangle, int vertex) {
  return surface.is_crack_face[at(triangle)] &&
         !(surface.is_old_face[at(triangle)] && surface.has_kerf[at(vertex)]);
}

std::optional<Vec3> find_normal(const TriangleMesh& mesh, const Triangle& triangle) {
  const Vec3& a = mesh.positions[at(triangle[0])];
  const Vec3 ab = mesh.positions[at(triangle[1])] - a, ac = mesh.positions[at(triangle[2])] - a;
  const Vec3 normal = ab.cross(ac);
  const double size = normal.norm();
  if (!(size > kFlatFace * (ab.squaredNorm() + ac.squaredNorm()))) return std::nullopt;
  return normal / size;
}

VertexFaces collect_faces(const SolidSurface& surface) {
  const TriangleMesh& mesh = surface.mesh;
  VertexFaces faces{std::vector<std::vector<Vec3>>(mesh.positions.size()),
                    std::vector<std::vector<Vec3>>(mesh.positions.size())};
  std::vector<char> is_at_crack(mesh.positions.size(), 0);
  for (Size t = 0; t < mesh.triangles.size(); ++t)
    for (const int v : mesh.triangles[t])
      if (stands_back(surface, static_cast<int>(t), v)) is_at_crack[at(v)] = 1;
  for (Size t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = mesh.triangles[t];
    if (!is_at_crack[at(a)] && !is_at_crack[at(b)] && !is_at_crack[at(c)]) continue;
    const std::optional<Vec3> normal = find_normal(mesh, mesh.triangles[t]);
    if (!normal) continue;
    for (const int v : mesh.triangles[t])
      if (is_at_crack[at(v)])
        add_normal(faces.cracks[at(v)], faces.outers[at(v)], stands_back(surface, static_cast<int>(t), v),
                   *normal);
  }
  return faces;
}

Vec3 retreat(const std::vector<Vec3>& cracks, const std::vector<Vec3>& outers, double kerf) {
  std::vector<Plane> planes, outer_faces;
  for (const Vec3& normal : cracks) planes.push_back({normal, -kerf, false});
  for (const Vec3& normal : outers) {
    planes.push_back({normal, 0.0, false});
    const bool is_known = std::any_of(outer_faces.begin(), outer_faces.end(),
                                      [&](const Plane& face) { return face.normal.dot(normal) > kSameFace; });
    if (!is_known) outer_faces.push_back({normal, 0.0, true});
  }
  std::vector<Plane> all = planes;
  all.insert(all.end(), outer_faces.begin(), outer_faces.end());
  const double tolerance = kRounding * kerf;
  const double most = kLongestRetreat * kerf;
  std::optional<Vec3> shift = ShortestShift(all, tolerance).find();
  // Where there is no way along the outer surface, or only a long one, a corner of that gives way.
  if (!shift || shift->norm() > most) shift = ShortestShift(planes, tolerance).find();
  if (!shift || shift->isZero(0.0)) return Vec3::Zero();
  return std::min(1.0, most / shift->norm()) * *shift;
}

}  // namespace shatterbox::geometry
