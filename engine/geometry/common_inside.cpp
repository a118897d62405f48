#include "engine/geometry/common_inside.h"

#include <optional>

#include "engine/core/index.h"
#include "engine/geometry/surface_distance.h"
#include "engine/geometry/winding_number.h"

namespace shatterbox::geometry {
namespace {

using core::at;

bool is_partly_inside(const TriangleMesh& mesh, const TriangleMesh& other, double least) {
  const Box bounds = box_of(other);
  std::optional<WindingNumber> winding;  // made when they are first asked
  std::optional<SurfaceDistance> distance;
  const auto is_inside = [&](const Vec3& p) {
    if ((p.array() <= bounds.low.array()).any() || (p.array() >= bounds.high.array()).any()) return false;
    if (!winding) winding.emplace(other);
    if (!(winding->about(p) > 0.5)) return false;
    if (!distance) distance.emplace(other);
    return distance->find(p, least).triangle < 0;
  };
  constexpr double kNearCorner = 0.9, kWithin = 2.0;
  constexpr std::size_t kMostAsked = 500;
  const std::size_t stride = mesh.triangles.size() / kMostAsked + 1;
  for (std::size_t k = 0; k < mesh.triangles.size(); k += stride) {
    const Triangle& t = mesh.triangles[k];
    const Vec3 &a = mesh.positions[at(t[0])], &b = mesh.positions[at(t[1])], &c = mesh.positions[at(t[2])];
    const Vec3 middle = (a + b + c) / 3.0;
    // Slightly within it: of what lies exactly in one place nothing else is.
    if (is_inside(middle) || is_inside(middle - kWithin * least * (b - a).cross(c - a).normalized()))
      return true;
    for (const Vec3& corner : {a, b, c})
      if (is_inside(middle + kNearCorner * (corner - middle))) return true;
  }
  return false;
}

}  // namespace

bool have_common_inside(const TriangleMesh& a, const TriangleMesh& b, double least) {
  return is_partly_inside(a, b, least) || is_partly_inside(b, a, least);
}

}  // namespace shatterbox::geometry
