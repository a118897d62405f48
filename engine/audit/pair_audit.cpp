#include "engine/audit/pair_audit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/audit/passage.h"
#include "engine/audit/triangle_crossing.h"
#include "engine/core/index.h"

namespace shatterbox::audit {
namespace {

using core::at;

constexpr double kRounding = 64.0 * std::numeric_limits<double>::epsilon();  // of the coordinates' size
constexpr double kTouch = 1e-9;  // of a radius: how deep a ball must be entered to be sure of it

Corners corners_of(const Surface& surface, const std::vector<Vec3>& positions, int triangle) {
  const auto& t = surface.triangles[at(triangle)];
  return {positions[at(t[0])], positions[at(t[1])], positions[at(t[2])]};
}

Bounds bounds_of(const Corners& corners) {
  Bounds bounds;
  for (const Vec3& c : corners) bounds.include(c);
  return bounds;
}

/// Calls visit(triangle of a, triangle of b) for all whose ways' boxes meet, until one returns false.
template <class Visit>
void for_each_near_pair(const Surface& a, const MovingSurface& moving_a, const Surface& b,
                        const MovingSurface& moving_b, const Visit& visit) {
  if (a.nodes.empty() || b.nodes.empty()) return;
  std::vector<std::pair<int, int>> stack{{0, 0}};
  while (!stack.empty()) {
    const auto [i, j] = stack.back();
    stack.pop_back();
    const Bounds &box_a = moving_a.nodes[at(i)], &box_b = moving_b.nodes[at(j)];
    if (!box_a.meets(box_b)) continue;
    const Surface::Node &node_a = a.nodes[at(i)], &node_b = b.nodes[at(j)];
    if (node_a.left < 0 && node_b.left < 0) {
      for (int k = node_a.begin; k < node_a.end; ++k) {
        const int s = a.order[at(k)];
        if (!moving_a.triangles[at(s)].meets(box_b)) continue;
        for (int l = node_b.begin; l < node_b.end; ++l) {
          const int t = b.order[at(l)];
          if (moving_a.triangles[at(s)].meets(moving_b.triangles[at(t)]) && !visit(s, t)) return;
        }
      }
    } else if (node_b.left < 0 ||
               (node_a.left >= 0 && (box_a.high - box_a.low).sum() > (box_b.high - box_b.low).sum())) {
      stack.emplace_back(node_a.left, j);
      stack.emplace_back(node_a.right, j);
    } else {
      stack.emplace_back(i, node_b.left);
      stack.emplace_back(i, node_b.right);
    }
  }
}

/// True if triangle t of b and its neighbour beyond an edge that lies in triangle s of a stand on both sides
/// of s.
bool cross_at_hinge(const Surface& a, const std::vector<Vec3>& positions_a, int s, const Surface& b,
                    const std::vector<Vec3>& positions_b, int t) {
  const Corners p = corners_of(a, positions_a, s), q = corners_of(b, positions_b, t);
  const int corner = corner_off_hinge(p, q);
  if (corner < 0) return false;
  const int edge = b.topology.triangle_edges[at(t)][at((corner + 1) % 3)];
  for (int k = b.topology.first_triangle[at(edge)]; k < b.topology.first_triangle[at(edge) + 1]; ++k) {
    const int other = b.topology.edge_triangles[at(k)];
    if (other == t) continue;
    const Corners r = corners_of(b, positions_b, other);
    const int other_corner = corner_off_hinge(p, r);
    if (other_corner >= 0 && are_on_both_sides(p, q[at(corner)], r[at(other_corner)])) return true;
  }
  return false;
}

bool cross(const Surface& a, const std::vector<Vec3>& positions_a, int s, const Surface& b,
           const std::vector<Vec3>& positions_b, int t) {
  const Corners p = corners_of(a, positions_a, s), q = corners_of(b, positions_b, t);
  if (!bounds_of(p).meets(bounds_of(q))) return false;
  return triangles_cross(p, q) || cross_at_hinge(a, positions_a, s, b, positions_b, t) ||
         cross_at_hinge(b, positions_b, t, a, positions_a, s);
}

template <std::size_t N>
Bounds way_of(const MovingSurface& moving, const std::array<int, N>& vertices) {
  Bounds bounds;
  for (const int v : vertices) {
    bounds.include(moving.start[at(v)]);
    bounds.include(moving.end[at(v)]);
  }
  return bounds;
}

void book(Passage passage, FindingKind kind, int feature_a, int feature_b, PairFindings& findings) {
  if (passage == Passage::passed) findings.add(kind, feature_a, feature_b);
  if (passage == Passage::unsettled) ++findings.unsettled;
}

/// Vertices that triangle s of a owns, through triangle t of b.
void pass_vertices(const Surface& a, const MovingSurface& moving_a, int s, const Surface& b,
                   const MovingSurface& moving_b, int t, bool is_flipped, PairFindings& findings) {
  const auto& triangle = b.triangles[at(t)];
  const auto points = [&](int v, const std::vector<Vec3>& x, const std::vector<Vec3>& y) {
    return FourPoints{x[at(v)], y[at(triangle[0])], y[at(triangle[1])], y[at(triangle[2])]};
  };
  for (std::size_t i = 0; i < 3; ++i) {
    if (!a.owns_corner[at(s)][i]) continue;
    const int v = a.triangles[at(s)][i];
    if (!way_of(moving_a, std::array{v}).meets(moving_b.triangles[at(t)])) continue;
    const Passage passage = vertex_through_triangle(points(v, moving_a.start, moving_b.start),
                                                    points(v, moving_a.end, moving_b.end));
    if (is_flipped) {
      book(passage, FindingKind::triangle_passage, t, v, findings);
    } else {
      book(passage, FindingKind::vertex_passage, v, t, findings);
    }
  }
}

void pass_edges(const Surface& a, const MovingSurface& moving_a, int s, const Surface& b,
                const MovingSurface& moving_b, int t, PairFindings& findings) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (!a.owns_edge[at(s)][i]) continue;
    const int edge_a = a.topology.triangle_edges[at(s)][i];
    const auto& ends_a = a.topology.edges[at(edge_a)];
    const Bounds way_a = way_of(moving_a, ends_a);
    if (!way_a.meets(moving_b.triangles[at(t)])) continue;
    for (std::size_t j = 0; j < 3; ++j) {
      if (!b.owns_edge[at(t)][j]) continue;
      const int edge_b = b.topology.triangle_edges[at(t)][j];
      const auto& ends_b = b.topology.edges[at(edge_b)];
      if (!way_a.meets(way_of(moving_b, ends_b))) continue;
      const auto points = [&](const std::vector<Vec3>& x, const std::vector<Vec3>& y) {
        return FourPoints{x[at(ends_a[0])], x[at(ends_a[1])], y[at(ends_b[0])], y[at(ends_b[1])]};
      };
      book(edge_through_edge(points(moving_a.start, moving_b.start), points(moving_a.end, moving_b.end)),
           FindingKind::edge_passage, edge_a, edge_b, findings);
    }
  }
}

/// Distance of a triangle from the origin.
double distance_to_origin(const Corners& t) {
  const Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]);
  bool is_inside = normal.squaredNorm() > 0.0;
  double least_squared = std::numeric_limits<double>::max();
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 &a = t[i], &b = t[(i + 1) % 3];
    const Vec3 edge = b - a;
    is_inside = is_inside && edge.cross(-a).dot(normal) >= 0.0;
    const double length_squared = edge.squaredNorm();
    const double share = length_squared > 0.0 ? std::clamp(-a.dot(edge) / length_squared, 0.0, 1.0) : 0.0;
    least_squared = std::min(least_squared, (a + share * edge).squaredNorm());
  }
  return is_inside ? std::abs(t[0].dot(normal)) / normal.norm() : std::sqrt(least_squared);
}

Corners seen_from(const Corners& corners, const Vec3& centre) {
  return {corners[0] - centre, corners[1] - centre, corners[2] - centre};
}

/// True if the triangle, seen from the ball's centre at both ends of the step, comes deeper into the ball
/// than a touch. Its distance changes no faster than its fastest corner moves.
bool dips_into(const Corners& start, const Corners& end, double radius) {
  double motion = 0.0;
  for (std::size_t i = 0; i < 3; ++i) motion = std::max(motion, (end[i] - start[i]).norm());
  struct Part {
    double from, width;
  };
  std::vector<Part> parts{{0.0, 1.0}};
  for (int tries = 0; !parts.empty() && tries < 4000; ++tries) {
    const Part part = parts.back();
    parts.pop_back();
    Corners middle;
    for (std::size_t i = 0; i < 3; ++i)
      middle[i] = start[i] + (part.from + 0.5 * part.width) * (end[i] - start[i]);
    const double distance = distance_to_origin(middle);
    if (distance < radius * (1.0 - kTouch)) return true;
    if (distance - 0.5 * part.width * motion > radius * (1.0 - kTouch)) continue;
    parts.push_back({part.from, 0.5 * part.width});
    parts.push_back({part.from + 0.5 * part.width, 0.5 * part.width});
  }
  return false;
}

double depth_margin(const Vec3& point, double size) {
  return kRounding * (point.cwiseAbs().maxCoeff() + size);
}

}  // namespace

void PairFindings::add(FindingKind kind, int feature_a, int feature_b) {
  Finding finding;
  finding.kind = kind;
  finding.feature_a = feature_a;
  finding.feature_b = feature_b;
  list.push_back(finding);
}

void audit_surfaces(const Surface& a, const MovingSurface& moving_a, const Surface& b,
                    const MovingSurface& moving_b, bool is_end, PairFindings& findings) {
  for_each_near_pair(a, moving_a, b, moving_b, [&](int s, int t) {
    if (is_end && cross(a, moving_a.end, s, b, moving_b.end, t)) {
      findings.add(FindingKind::crossing, s, t);
      findings.has_crossing = true;
    }
    pass_vertices(a, moving_a, s, b, moving_b, t, false, findings);
    pass_vertices(b, moving_b, t, a, moving_a, s, true, findings);
    pass_edges(a, moving_a, s, b, moving_b, t, findings);
    return true;
  });
}

bool do_cross(const Surface& a, const MovingSurface& moving_a, const Surface& b,
              const MovingSurface& moving_b, std::vector<Vec3> MovingSurface::*when) {
  bool crosses = false;
  for_each_near_pair(a, moving_a, b, moving_b, [&](int s, int t) {
    crosses = cross(a, moving_a.*when, s, b, moving_b.*when, t);
    return !crosses;
  });
  return crosses;
}

bool is_below_plane(const std::vector<Vec3>& points, double radius, const Pose& plane) {
  const Vec3 normal = plane.rotation * Vec3::UnitY();
  return std::any_of(points.begin(), points.end(), [&](const Vec3& p) {
    return normal.dot(p - plane.translation) < radius - depth_margin(p, radius + plane.translation.norm());
  });
}

void audit_plane(const MovingSurface& moving, double radius, const Pose& plane, PairFindings& findings) {
  for (std::size_t v = 0; v < moving.end.size(); ++v) {
    if (!is_below_plane({moving.end[v]}, radius, plane)) continue;
    findings.add(FindingKind::sunk_in_plane, static_cast<int>(v), 0);
    findings.has_crossing = true;
  }
}

void audit_sphere(const Surface& a, const MovingSurface& moving_a, const Vec3& centre_start,
                  const Vec3& centre_end, double radius, bool is_end, PairFindings& findings) {
  Bounds way;
  way.include(centre_start);
  way.include(centre_end);
  way.low.array() -= radius;
  way.high.array() += radius;
  for (int t = 0; t < static_cast<int>(a.triangles.size()); ++t) {
    if (!moving_a.triangles[at(t)].meets(way)) continue;
    const Corners start = corners_of(a, moving_a.start, t), end = corners_of(a, moving_a.end, t);
    const Corners from_start = seen_from(start, centre_start), from_end = seen_from(end, centre_end);
    const bool is_inside = distance_to_origin(from_end) < radius * (1.0 - kTouch);
    if (is_inside && is_end) {
      findings.add(FindingKind::sunk_in_sphere, t, 0);
      findings.has_crossing = true;
    }
    const Passage passage = vertex_through_triangle({centre_start, start[0], start[1], start[2]},
                                                    {centre_end, end[0], end[1], end[2]});
    const bool was_inside = distance_to_origin(from_start) < radius * (1.0 - kTouch);
    const bool dipped = !was_inside && (is_inside ? !is_end : dips_into(from_start, from_end, radius));
    if (passage == Passage::passed || dipped) findings.add(FindingKind::sphere_passage, t, 0);
  }
}

bool crosses_sphere_at_start(const Surface& a, const MovingSurface& moving_a, const Vec3& centre,
                             double radius) {
  for (int t = 0; t < static_cast<int>(a.triangles.size()); ++t) {
    if (distance_to_origin(seen_from(corners_of(a, moving_a.start, t), centre)) < radius * (1.0 - kTouch))
      return true;
  }
  return false;
}

bool do_balls_cross_at_start(const MovingBall& a, const MovingBall& b) {
  return (b.centre[0] - a.centre[0]).norm() < (a.radius + b.radius) * (1.0 - kTouch);
}

void audit_balls(const MovingBall& a, const MovingBall& b, bool is_end, PairFindings& findings) {
  const double reach = (a.radius + b.radius) * (1.0 - kTouch);
  const Vec3 start = b.centre[0] - a.centre[0], end = b.centre[1] - a.centre[1], way = end - start;
  const bool is_inside = end.norm() < reach;
  if (is_inside && is_end) {
    findings.add(FindingKind::sunk_in_sphere, 0, 0);
    findings.has_crossing = true;
  }
  const double length_squared = way.squaredNorm();
  const double share = length_squared > 0.0 ? std::clamp(-start.dot(way) / length_squared, 0.0, 1.0) : 0.0;
  const bool dipped = is_inside ? !is_end : (start + share * way).norm() < reach;
  if (dipped && !do_balls_cross_at_start(a, b)) findings.add(FindingKind::sphere_passage, 0, 0);
}

}  // namespace shatterbox::audit
