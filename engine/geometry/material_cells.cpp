#include "engine/geometry/material_cells.h"

#include <algorithm>
#include <array>

#include "engine/core/disjoint_sets.h"
#include "engine/core/elementary.h"
#include "engine/core/index.h"

namespace shatterbox::geometry {
namespace {

using Size = std::size_t;
using core::at;

/// Calls visit(a, b, c) for the triangles of a polygon's fan, counter-clockwise seen from outside.
template <class Visit>
void for_each_triangle_of(const std::vector<Vec3>& positions, const ElementPolygon& polygon,
                          const Visit& visit) {
  const Vec3& a = positions[at(polygon.corners[0])];
  for (int i = 2; i < polygon.corner_count; ++i) {
    const Vec3& b = positions[at(polygon.corners[i - 1])];
    const Vec3& c = positions[at(polygon.corners[i])];
    polygon.is_reversed ? visit(a, c, b) : visit(a, b, c);
  }
}

/// The number of the set of polygons that hang together by their sides, for each polygon.
std::vector<int> join_by_sides(const std::vector<ElementPolygon>& polygons) {
  struct Side {
    int low, high, polygon;
  };
  std::vector<Side> sides;
  for (Size p = 0; p < polygons.size(); ++p)
    for (int i = 0; i < polygons[p].corner_count; ++i) {
      const int a = polygons[p].corners[i], b = polygons[p].corners[(i + 1) % polygons[p].corner_count];
      sides.push_back({std::min(a, b), std::max(a, b), static_cast<int>(p)});
    }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::array{a.low, a.high, a.polygon} < std::array{b.low, b.high, b.polygon};
  });
  core::DisjointSets sets(polygons.size());
  for (Size s = 1; s < sides.size(); ++s)
    if (sides[s].low == sides[s - 1].low && sides[s].high == sides[s - 1].high)
      sets.unite(sides[s].polygon, sides[s - 1].polygon);
  std::vector<int> numbers(polygons.size());
  int count = 0;
  for (Size p = 0; p < polygons.size(); ++p) {
    const int root = sets.find(static_cast<int>(p));
    numbers[p] = root == static_cast<int>(p) ? count++ : numbers[at(root)];
  }
  return numbers;
}

/// Volume and centroid of what the polygons of each part enclose, about a corner of theirs.
std::vector<MaterialPart> measure_parts(const std::vector<Vec3>& positions,
                                        const std::vector<ElementPolygon>& polygons) {
  std::vector<MaterialPart> parts;
  std::vector<Vec3> references, first_moments;
  for (const ElementPolygon& polygon : polygons) {
    if (polygon.part == static_cast<int>(parts.size())) {
      parts.emplace_back();
      references.push_back(positions[at(polygon.corners[0])]);
      first_moments.push_back(Vec3::Zero());
    }
    const Size k = at(polygon.part);
    for_each_triangle_of(positions, polygon, [&](const Vec3& a, const Vec3& b, const Vec3& c) {
      const Vec3 p = a - references[k], q = b - references[k], r = c - references[k];
      const double volume = p.dot(q.cross(r)) / 6.0;
      parts[k].volume += volume;
      first_moments[k] += 0.25 * volume * (p + q + r);
    });
  }
  for (Size k = 0; k < parts.size(); ++k) {
    parts[k].centroid = references[k];
    if (parts[k].volume != 0.0) parts[k].centroid += first_moments[k] / parts[k].volume;
  }
  return parts;
}

/// How many times the polygons of a part go round a point: their solid angles [VOS83], over 4 pi.
double turns_about(const std::vector<Vec3>& positions, const std::vector<ElementPolygon>& polygons, int part,
                   const Vec3& point) {
  double sum = 0.0;
  for (const ElementPolygon& polygon : polygons) {
    if (polygon.part != part) continue;
    for_each_triangle_of(positions, polygon, [&](const Vec3& a, const Vec3& b, const Vec3& c) {
      const Vec3 p = a - point, q = b - point, r = c - point;
      const double x = p.norm(), y = q.norm(), z = r.norm();
      sum += 2.0 * core::atan2(p.dot(q.cross(r)), x * y * z + p.dot(q) * z + q.dot(r) * x + r.dot(p) * y);
    });
  }
  return sum / (4.0 * core::kPi);
}

}  // namespace

std::vector<MaterialPart> divide_into_parts(const std::vector<Vec3>& positions,
                                            std::vector<ElementPolygon>& polygons, double least_volume) {
  const std::vector<int> numbers = join_by_sides(polygons);
  for (Size p = 0; p < polygons.size(); ++p) polygons[p].part = numbers[p];
  std::vector<MaterialPart> parts = measure_parts(positions, polygons);
  if (parts.size() < 2) return parts;
  std::vector<int> owner(parts.size());
  for (Size k = 0; k < parts.size(); ++k) {
    owner[k] = static_cast<int>(k);
    if (parts[k].volume >= -least_volume) continue;
    // A hollow: the smallest part around one of its corners.
    const auto its = std::find_if(polygons.begin(), polygons.end(),
                                  [&](const ElementPolygon& p) { return p.part == static_cast<int>(k); });
    const Vec3& corner = positions[at(its->corners[0])];
    for (Size other = 0; other < parts.size(); ++other) {
      if (parts[other].volume <= least_volume) continue;
      const bool is_better =
          owner[k] == static_cast<int>(k) || parts[other].volume < parts[at(owner[k])].volume;
      if (is_better && turns_about(positions, polygons, static_cast<int>(other), corner) > 0.5)
        owner[k] = static_cast<int>(other);
    }
  }
  std::vector<int> renumbered(parts.size(), -1);
  int count = 0;
  for (ElementPolygon& polygon : polygons) {
    const Size k = at(owner[at(polygon.part)]);
    if (renumbered[k] < 0) renumbered[k] = count++;
    polygon.part = renumbered[k];
  }
  return measure_parts(positions, polygons);
}

}  // namespace shatterbox::geometry
