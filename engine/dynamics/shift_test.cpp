#include "engine/dynamics/shift_test.h"

#include <algorithm>
#include <array>

#include "engine/core/index.h"
#include "engine/geometry/closest_points.h"
#include "engine/geometry/orientation.h"

namespace shatterbox::dynamics {
namespace {

using core::at;
using geometry::orientation;
using Triple = std::array<Vec3, 3>;

Triple corners_of(const collision::PlacedCollider& placed, int triangle) {
  const geometry::Triangle& t = placed.collider->triangles[at(triangle)];
  return {placed.start[at(t[0])], placed.start[at(t[1])], placed.start[at(t[2])]};
}

std::array<Vec3, 2> ends_of(const collision::PlacedCollider& placed, int edge) {
  const std::array<int, 2>& e = placed.collider->edges[at(edge)];
  return {placed.start[at(e[0])], placed.start[at(e[1])]};
}

/// A point that goes from p to q in the triangle's frame; `after` is its side then.
bool point_passes(const Vec3& p, const Vec3& q, const Triple& t, int after) {
  if (orientation(t[0], t[1], t[2], p) * after >= 0) return false;
  const int turns[] = {orientation(p, q, t[0], t[1]), orientation(p, q, t[1], t[2]),
                       orientation(p, q, t[2], t[0])};
  return *std::min_element(turns, turns + 3) >= 0 || *std::max_element(turns, turns + 3) <= 0;
}

/// An edge p that is at q afterwards, and one that stays.
bool edge_passes(const std::array<Vec3, 2>& p, const std::array<Vec3, 2>& q, const std::array<Vec3, 2>& edge,
                 double distance) {
  if (orientation(p[0], p[1], edge[0], edge[1]) * orientation(q[0], q[1], edge[0], edge[1]) >= 0)
    return false;
  const double before = geometry::oriented_volume(p[0], p[1], edge[0], edge[1]);
  const double after = geometry::oriented_volume(q[0], q[1], edge[0], edge[1]);
  const double share = before / (before - after);  // of the way: volumes change evenly with a shift
  const Vec3 a = p[0] + share * (q[0] - p[0]), b = p[1] + share * (q[1] - p[1]);
  constexpr double kMeets = 1e-3;  // of the shift
  return geometry::closest_between_segments(a, b, edge[0], edge[1]).distance < kMeets * distance;
}

}  // namespace

bool goes_through(const collision::PlacedCollider& before, const collision::PlacedCollider& after,
                  const collision::PlacedCollider& other, double distance) {
  collision::FeatureList near;
  collision::list_near_features(before, other, 2.0 * distance, near);
  return std::any_of(near.begin(), near.end(), [&](const collision::FeaturePair& pair) {
    switch (pair.kind) {
      case collision::FeatureKind::vertex_triangle: {
        const Triple t = corners_of(other, pair.b);
        const Vec3 &p = before.start[at(pair.a)], &q = after.start[at(pair.a)];
        return point_passes(p, q, t, orientation(t[0], t[1], t[2], q));
      }
      case collision::FeatureKind::triangle_vertex: {
        const Triple t = corners_of(before, pair.a), later = corners_of(after, pair.a);
        const Vec3& p = other.start[at(pair.b)];
        return point_passes(p, p - (later[0] - t[0]), t, orientation(later[0], later[1], later[2], p));
      }
      case collision::FeatureKind::edge_edge:
        return edge_passes(ends_of(before, pair.a), ends_of(after, pair.a), ends_of(other, pair.b), distance);
    }
    return false;
  });
}

}  // namespace shatterbox::dynamics
