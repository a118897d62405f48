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

/// The part about a hollow: of those that most of its corners lie in (some may touch its border) the
/// smallest.
int find_owner(const std::vector<Vec3>& positions, const std::vector<ElementPolygon>& polygons,
               const std::vector<MaterialPart>& parts, int hollow, double least_volume) {
  std::vector<int> corners;
  for (const ElementPolygon& polygon : polygons)
    if (polygon.part == hollow)
      corners.insert(corners.end(), polygon.corners, polygon.corners + polygon.corner_count);
  int smallest = -1, likeliest = hollow;
  double most = 0.0;
  for (int part = 0; part < static_cast<int>(parts.size()); ++part) {
    if (parts[at(part)].volume <= least_volume) continue;
    double turns = 0.0;
    for (const int v : corners) turns += turns_about(positions, polygons, part, positions[at(v)]);
    turns /= static_cast<double>(corners.size());
    if (turns > 0.5 && (smallest < 0 || parts[at(part)].volume < parts[at(smallest)].volume)) smallest = part;
    if (turns > most) {
      most = turns;
      likeliest = part;
    }
  }
  return smallest >= 0 ? smallest : likeliest;
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
    const bool is_hollow = parts[k].volume < -least_volume;
    owner[k] = static_cast<int>(k);
    if (is_hollow) owner[k] = find_owner(positions, polygons, parts, owner[k], least_volume);
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
