#include "engine/fracture/striker.h"

#include <algorithm>

#include "engine/core/elementary.h"
#include "engine/geometry/plane_lines.h"

namespace shatterbox::fracture {
using geometry::turn;

StrikerSection section_of(const Striker& striker) {
  StrikerSection section;
  const std::size_t n = striker.core.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 &a = striker.core[i], &b = striker.core[(i + 1) % n];
    section.area += 0.5 * (a.x() * b.y() - a.y() * b.x());
    section.perimeter += (b - a).norm();
  }
  section.area += striker.radius * (section.perimeter + core::kPi * striker.radius);
  section.perimeter += 2.0 * core::kPi * striker.radius;
  section.diameter = 2.0 * core::sqrt(std::max(0.0, section.area) / core::kPi);
  return section;
}

std::vector<Vec2> convex_hull(std::vector<Vec2> points) {
  std::sort(points.begin(), points.end(),
            [](const Vec2& a, const Vec2& b) { return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y(); });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  std::vector<Vec2> hull;  // the lower chain, then the upper one (Andrew 1979)
  const auto add = [&hull](const Vec2& p, std::size_t kept) {
    while (hull.size() > kept && turn(hull[hull.size() - 2], hull.back(), p) <= 0.0) hull.pop_back();
    hull.push_back(p);
  };
  for (const Vec2& p : points) add(p, 1);
  const std::size_t lower = hull.size();
  for (std::size_t i = points.size() - 1; i-- > 0;) add(points[i], lower);
  hull.pop_back();
  return hull;
}

}  // namespace shatterbox::fracture
