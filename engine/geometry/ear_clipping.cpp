#include "engine/geometry/ear_clipping.h"

#include <numeric>

namespace shatterbox::geometry {
namespace {

double cross2(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
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
      if (quality > best_quality) {
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
