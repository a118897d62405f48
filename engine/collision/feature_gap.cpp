#include "engine/collision/feature_gap.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/core/index.h"
#include "engine/geometry/closest_points.h"
#include "engine/geometry/moving_plane.h"

namespace shatterbox::collision {
namespace {

using core::at;

// Where impulses of the pair act (Contact::lean): at the vertex, as it slides over the triangle.
double lean(const FeaturePair& pair) {
  if (pair.kind == FeatureKind::edge_edge) return 0.5;
  return pair.kind == FeatureKind::vertex_triangle ? 1.0 : 0.0;
}

// No neighbour of `vertex` leads along `direction` by more than the slack.
bool leads_away_at_vertex(const Collider& c, const std::vector<Vec3>& positions, int vertex,
                          const Vec3& direction, double slack) {
  for (int i = c.neighbour_begin[at(vertex)]; i < c.neighbour_begin[at(vertex) + 1]; ++i) {
    const Vec3 edge = positions[at(c.neighbours[at(i)])] - positions[at(vertex)];
    const double along = edge.dot(direction);
    if (along > 0.0 && along * along > slack * slack * edge.squaredNorm()) return false;
  }
  return true;
}

// No triangle of `edge` leads along `direction` by more than the slack.
bool leads_away_at_edge(const Collider& c, const std::vector<Vec3>& positions, int edge,
                        const Vec3& direction, double slack) {
  const Vec3& from = positions[at(c.edges[at(edge)][0])];
  const Vec3 way = positions[at(c.edges[at(edge)][1])] - from;
  const double length_squared = way.squaredNorm();
  if (length_squared == 0.0) return true;
  for (int i = c.opposite_begin[at(edge)]; i < c.opposite_begin[at(edge) + 1]; ++i) {
    Vec3 inward = positions[at(c.opposites[at(i)])] - from;
    inward -= way * (inward.dot(way) / length_squared);
    const double along = inward.dot(direction);
    if (along > 0.0 && along * along > slack * slack * inward.squaredNorm()) return false;
  }
  return true;
}

bool leads_away_at_triangle(const Collider& c, const std::vector<Vec3>& positions, int triangle,
                            const double* weights, const Vec3& direction, double slack) {
  const auto& corners = c.triangles[at(triangle)];
  int zeros = 0, last_zero = 0, last_positive = 0;
  for (int i = 0; i < 3; ++i) {
    if (weights[i] <= 0.0) {
      ++zeros;
      last_zero = i;
    } else {
      last_positive = i;
    }
  }
  if (zeros == 0) return true;
  if (zeros == 1) {  // on the edge opposite to corner `last_zero`
    const int edge = c.triangle_edges[at(triangle)][at((last_zero + 1) % 3)];
    return leads_away_at_edge(c, positions, edge, direction, slack);
  }
  return leads_away_at_vertex(c, positions, corners[at(last_positive)], direction, slack);
}

template <class PlaceA, class PlaceB>
FeaturePoints gather_points(const FeaturePair& pair, const Collider& a, const PlaceA& place_a,
                            const Collider& b, const PlaceB& place_b) {
  FeaturePoints result;
  result.radius_a = a.radius;
  result.radius_b = b.radius;
  // One by one: a list would be stored and copied by wider loads, each of which waits for two stores.
  auto& points = result.points;
  if (pair.kind == FeatureKind::edge_edge) {
    const auto& edge_a = a.edges[at(pair.a)];
    const auto& edge_b = b.edges[at(pair.b)];
    result.is_edge_edge = true;
    points[0] = place_a(edge_a[0]);
    points[1] = place_a(edge_a[1]);
    points[2] = place_b(edge_b[0]);
    points[3] = place_b(edge_b[1]);
    return result;
  }
  result.is_flipped = pair.kind == FeatureKind::triangle_vertex;
  if (result.is_flipped) {
    const auto& t = a.triangles[at(pair.a)];
    points[0] = place_b(pair.b);
    for (std::size_t i = 0; i < 3; ++i) points[i + 1] = place_a(t[i]);
  } else {
    const auto& t = b.triangles[at(pair.b)];
    points[0] = place_a(pair.a);
    for (std::size_t i = 0; i < 3; ++i) points[i + 1] = place_b(t[i]);
  }
  return result;
}

}  // namespace

FeaturePoints gather(const FeaturePair& pair, const Collider& a, const std::vector<Vec3>& positions_a,
                     const Collider& b, const std::vector<Vec3>& positions_b) {
  return gather_points(
      pair, a, [&](int v) -> const Vec3& { return positions_a[at(v)]; }, b,
      [&](int v) -> const Vec3& { return positions_b[at(v)]; });
}

FeaturePoints gather(const FeaturePair& pair, const Collider& a, const Pose& pose_a, const Collider& b,
                     const Pose& pose_b) {
  return gather_points(
      pair, a, [&](int v) { return pose_a.apply(a.vertices[at(v)]); }, b,
      [&](int v) { return pose_b.apply(b.vertices[at(v)]); });
}

FeatureGap measure(const FeaturePoints& f, const Vec3& hint) {
  constexpr double kNoDirection = 1e-14;  // of the features' size: rounding, not a direction
  FeatureGap result;
  Vec3 spare;
  if (f.is_edge_edge) {
    const auto c = geometry::closest_between_segments(f.points[0], f.points[1], f.points[2], f.points[3]);
    result.weights = {1.0 - c.s, c.s, 1.0 - c.t, c.t};
    result.on_a = c.on_p;
    result.on_b = c.on_q;
    result.distance = c.distance;
  } else {
    const auto c = geometry::closest_on_triangle(f.points[0], f.points[1], f.points[2], f.points[3]);
    result.weights = {1.0, c.barycentric[0], c.barycentric[1], c.barycentric[2]};
    result.on_a = f.is_flipped ? c.closest : f.points[0];
    result.on_b = f.is_flipped ? f.points[0] : c.closest;
    result.distance = c.distance;
  }
  const Vec3 e = f.points[3] - f.points[2];
  if (result.distance > kNoDirection * (e.cwiseAbs().maxCoeff() + f.radii()) && result.distance > 1e-150) {
    result.normal = (result.on_a - result.on_b) / result.distance;
  } else {
    spare = f.is_edge_edge ? Vec3((f.points[1] - f.points[0]).cross(e))
                           : Vec3((f.points[2] - f.points[1]).cross(e));
    const double length = spare.norm();
    result.normal = length > 1e-150 ? Vec3(spare / length) : Vec3::UnitY();
    if (result.normal.dot(hint) < 0.0) result.normal = -result.normal;
  }
  result.gap = result.distance - f.radii();
  if (f.radius_a > 0.0) result.on_a -= f.radius_a * result.normal;
  if (f.radius_b > 0.0) result.on_b += f.radius_b * result.normal;
  return result;
}

double separation_along(const FeaturePoints& f, const Vec3& direction) {
  std::array<double, 4> along;
  for (std::size_t i = 0; i < 4; ++i) along[i] = direction.dot(f.points[i]);
  if (f.is_edge_edge) return std::min(along[0], along[1]) - std::max(along[2], along[3]) - f.radii();
  if (f.is_flipped) return std::min(std::min(along[1], along[2]), along[3]) - along[0] - f.radii();
  return along[0] - std::max(std::max(along[1], along[2]), along[3]) - f.radii();
}

double separation_along(const FeaturePair& pair, const Collider& a, const std::vector<Vec3>& positions_a,
                        const Collider& b, const std::vector<Vec3>& positions_b, const Vec3& direction) {
  const auto along_a = [&](int v) { return direction.dot(positions_a[at(v)]); };
  const auto along_b = [&](int v) { return direction.dot(positions_b[at(v)]); };
  const double radii = a.radius + b.radius;
  if (pair.kind == FeatureKind::edge_edge) {
    const auto &p = a.edges[at(pair.a)], &q = b.edges[at(pair.b)];
    return std::min(along_a(p[0]), along_a(p[1])) - std::max(along_b(q[0]), along_b(q[1])) - radii;
  }
  if (pair.kind == FeatureKind::triangle_vertex) {
    const auto& t = a.triangles[at(pair.a)];
    return std::min(std::min(along_a(t[0]), along_a(t[1])), along_a(t[2])) - along_b(pair.b) - radii;
  }
  const auto& t = b.triangles[at(pair.b)];
  return along_a(pair.a) - std::max(std::max(along_b(t[0]), along_b(t[1])), along_b(t[2])) - radii;
}

bool is_local_minimum(const FeaturePair& pair, const FeatureGap& gap, const Collider& a,
                      const std::vector<Vec3>& positions_a, const Collider& b,
                      const std::vector<Vec3>& positions_b, double slack) {
  const Vec3 towards_b = -gap.normal;
  switch (pair.kind) {
    case FeatureKind::vertex_triangle:
      return leads_away_at_vertex(a, positions_a, pair.a, towards_b, slack) &&
             leads_away_at_triangle(b, positions_b, pair.b, &gap.weights[1], gap.normal, slack);
    case FeatureKind::triangle_vertex:
      return leads_away_at_vertex(b, positions_b, pair.b, gap.normal, slack) &&
             leads_away_at_triangle(a, positions_a, pair.a, &gap.weights[1], towards_b, slack);
    case FeatureKind::edge_edge:
      // At an edge's end the pair is a vertex against a triangle, and listed as such.
      for (const double weight : gap.weights) {
        if (weight <= 0.0 || weight >= 1.0) return false;
      }
      return leads_away_at_edge(a, positions_a, pair.a, towards_b, slack) &&
             leads_away_at_edge(b, positions_b, pair.b, gap.normal, slack);
  }
  return true;
}

PathResult follow_paths(const FeaturePoints& start, const FeaturePoints& end, double least, const Vec3& hint,
                        const FeatureGap* start_gap) {
  constexpr int kMostSteps = 200;
  constexpr int kTurnsTogether = 3;  // steps after which this is thought of
  constexpr double kAdvance = 0.95;
  const std::size_t split = start.is_edge_edge ? 2 : 1;  // points [0, split) are one body's
  std::array<Vec3, 4> ways;
  for (std::size_t i = 0; i < 4; ++i) ways[i] = end.points[i] - start.points[i];
  PathResult result;
  result.time = 0.0;
  FeaturePoints now;
  FeatureGap measured;
  const FeatureGap* gap = start_gap;
  if (!gap) {
    measured = measure(start, hint);
    gap = &measured;
  }
  for (int step = 0; step < kMostSteps; ++step) {
    // From the second group of points to the first.
    const double sign = start.is_flipped ? -1.0 : 1.0;
    std::array<double, 4> along;
    for (std::size_t i = 0; i < 4; ++i) along[i] = sign * gap->normal.dot(ways[i]);
    const double first = split == 2 ? std::min(along[0], along[1]) : along[0];
    const double second = std::max(split == 2 ? along[2] : std::max(along[1], along[2]), along[3]);
    const double closing = second - first;
    const double room = gap->gap - least;
    // n separates the pair at both ends of what is left, hence all along the straight paths.
    const double left = room - std::max(0.0, closing) * (1.0 - result.time);
    if (closing <= 0.0 || left > 0.0) {
      result.spare = std::max(0.0, std::min(result.spare, left));
      result.time = 1.0;
      return result;
    }
    if (room <= 0.1 * std::abs(least) || room <= 1e-14 * std::abs(gap->distance)) break;
    result.spare = std::min(result.spare, (1.0 - kAdvance) * room);
    result.time = std::min(1.0, result.time + kAdvance * room / closing);
    if (step == 0) now = start;
    for (std::size_t i = 0; i < 4; ++i) now.points[i] = start.points[i] + result.time * ways[i];
    measured = measure(now, hint);
    gap = &measured;
    if (step != kTurnsTogether) continue;
    const Vec3 direction = sign * measured.normal;
    const double apart =
        geometry::separation_by_moving_plane(now.points, end.points, start.is_edge_edge, direction);
    if (apart - start.radii() <= least) continue;
    result.spare = std::min(result.spare, apart - start.radii() - least);
    result.time = 1.0;
    return result;
  }
  result.has_hit = true;
  result.gap = *gap;
  return result;
}

Contact contact_here(const FeaturePair& features, const FeaturePoints& here, const FeatureGap& gap) {
  Contact c;
  c.key = features.key();
  c.on_a = gap.on_a;
  c.on_b = gap.on_b;
  c.normal = gap.normal;
  c.gap = gap.gap;
  c.lean = lean(features);
  if (here.is_edge_edge) {
    set_crossing_edges(here.points[1] - here.points[0], here.points[3] - here.points[2], c);
  } else if (gap.weights[1] > 0.0 && gap.weights[2] > 0.0 && gap.weights[3] > 0.0) {
    c.normal_of = here.is_flipped ? NormalOf::face_a : NormalOf::face_b;
  }
  return c;
}

Contact contact_at_impact(const FeaturePair& features, const FeaturePoints& start, const FeatureGap& hit) {
  Contact c;
  c.key = features.key();
  c.normal = hit.normal;
  c.is_time_of_impact = true;
  c.lean = lean(features);
  const int split = start.is_edge_edge ? 2 : 1;
  Vec3 first = Vec3::Zero(), second = Vec3::Zero();
  for (int i = 0; i < 4; ++i) (i < split ? first : second) += hit.weights[at(i)] * start.points[at(i)];
  c.on_a = start.is_flipped ? second : first;
  c.on_b = start.is_flipped ? first : second;
  if (start.radius_a > 0.0) c.on_a -= start.radius_a * hit.normal;
  if (start.radius_b > 0.0) c.on_b += start.radius_b * hit.normal;
  c.gap = c.normal.dot(c.on_a - c.on_b);
  return c;
}

bool are_within(const PlacedCollider& a, const PlacedCollider& b, double distance) {
  FeatureList near;
  list_near_features(a, b, distance, near);
  return std::any_of(near.begin(), near.end(), [&](const FeaturePair& features) {
    return measure(gather(features, *a.collider, a.start, *b.collider, b.start), Vec3::UnitY()).gap <=
           distance;
  });
}

}  // namespace shatterbox::collision
