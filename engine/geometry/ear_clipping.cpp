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

double ear_area(const std::vector<Vec2>& polygon, std::size_t i) {
  const Vec2& p = polygon[(i + polygon.size() - 1) % polygon.size()];
  return cross2(polygon[i] - p, polygon[(i + 1) % polygon.size()] - p);
}

/// The corner with the best-shaped ear of those that leave more than a line of the `left` area behind (both
/// twice the area, as is `least`); the number of corners if there is none.
std::size_t find_ear(const std::vector<Vec2>& polygon, double left, double least, bool may_hold_corners) {
  std::size_t best = polygon.size();
  double best_quality = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2& p = polygon[(i + polygon.size() - 1) % polygon.size()];
    const Vec2& q = polygon[i];
    const Vec2& r = polygon[(i + 1) % polygon.size()];
    const double area = ear_area(polygon, i);
    if (!(area > least) || (polygon.size() > 3 && !(left - area > least))) continue;
    const double quality = area / ((q - p).squaredNorm() + (r - q).squaredNorm() + (p - r).squaredNorm());
    if (!(quality > best_quality) || (!may_hold_corners && holds_corner(polygon, i))) continue;
    best = i;
    best_quality = quality;
  }
  return best;
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
    std::size_t ear = find_ear(polygon, left, least, false);
    if (ear == ring.size()) ear = find_ear(polygon, left, least, true);  // it crosses itself by a little
    if (ear == ring.size()) break;                                       // what is left has no area
    triangles.push_back(
        {ring[(ear + ring.size() - 1) % ring.size()], ring[ear], ring[(ear + 1) % ring.size()]});
    left -= ear_area(polygon, ear);
    ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(ear));
    polygon.erase(polygon.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  return triangles;
}

}  // namespace shatterbox::geometry
