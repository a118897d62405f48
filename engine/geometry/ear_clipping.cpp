#include "engine/geometry/ear_clipping.h"

#include <numeric>

namespace shatterbox::geometry {
namespace {

double cross2(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Whether a corner of the polygon lies within the triangle of the corner `i` and its neighbours, which cuts
/// off more than an ear then.
bool holds_corner(const std::vector<Vec2>& polygon, std::size_t i) {
  const std::size_t before = (i + polygon.size() - 1) % polygon.size(), after = (i + 1) % polygon.size();
  const Vec2 &p = polygon[before], &q = polygon[i], &r = polygon[after];
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec2& x = polygon[k];
    if (k != before && k != i && k != after && cross2(q - p, x - p) > 0.0 && cross2(r - q, x - q) > 0.0 &&
        cross2(p - r, x - r) > 0.0)
      return true;
  }
  return false;
}

}  // namespace

std::vector<Triangle> clip_ears(std::vector<Vec2> polygon) {
  std::vector<Triangle> triangles;
  std::vector<int> ring(polygon.size());
  std::iota(ring.begin(), ring.end(), 0);
  double left = 0.0;
  for (std::size_t i = 2; i < polygon.size(); ++i)
    left += cross2(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
  const double least = 1e-12 * left;
  while (ring.size() >= 3) {
    std::size_t best = ring.size();
    double best_quality = 0.0;
    double best_area = 0.0;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Vec2& p = polygon[(i + ring.size() - 1) % ring.size()];
      const Vec2& q = polygon[i];
      const Vec2& r = polygon[(i + 1) % ring.size()];
      const double area = cross2(q - p, r - p);
      if (!(area > least) || (ring.size() > 3 && !(left - area > least))) continue;
      const double quality = area / ((q - p).squaredNorm() + (r - q).squaredNorm() + (p - r).squaredNorm());
      if (quality > best_quality && !holds_corner(polygon, i)) {
        best = i;
        best_quality = quality;
        best_area = area;
      }
    }
    if (best == ring.size()) break;  // what is left has no area
    triangles.push_back(
        {ring[(best + ring.size() - 1) % ring.size()], ring[best], ring[(best + 1) % ring.size()]});
    left -= best_area;
    ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(best));
    polygon.erase(polygon.begin() + static_cast<std::ptrdiff_t>(best));
  }
  return triangles;
}

}  // namespace shatterbox::geometry
