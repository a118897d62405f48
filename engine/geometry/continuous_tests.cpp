#include "engine/geometry/continuous_tests.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/index.h"
#include "engine/core/vec.h"
#include "engine/geometry/closest_points.h"

namespace shatterbox::geometry {
namespace {

using core::at;

constexpr double kUnit = 0.5 * std::numeric_limits<double>::epsilon();  // of rounding, 2^-53
constexpr double kTiny = 1e-250;                                        // above what underflow can take away
constexpr int kMostIterations = 4000;

/// The differences x_i - x_j of all vertices i of the first feature and j of the second, at both ends: all
/// that matters, and each rounded by no more than 2^-53 of itself, however far away the origin is.
struct Paths {
  int first = 1, second = 3;                 // vertices of the first and the second feature
  std::array<Vec3, 4> from_start, from_end;  // all four vertices, seen from the last one
  std::array<Vec3, 4> start, end;            // pair i * second + j
};

Vec3 point_of(const double* numbers, int i) {
  return {numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]};
}

Paths make_paths(const double* first_start, const double* second_start, const double* first_end,
                 const double* second_end, int first) {
  Paths paths;
  paths.first = first;
  paths.second = 4 - first;
  const Vec3 base_start = point_of(second_start, paths.second - 1);
  const Vec3 base_end = point_of(second_end, paths.second - 1);
  for (int i = 0; i < 4; ++i) {
    const bool is_first = i < first;
    paths.from_start[at(i)] =
        (is_first ? point_of(first_start, i) : point_of(second_start, i - first)) - base_start;
    paths.from_end[at(i)] = (is_first ? point_of(first_end, i) : point_of(second_end, i - first)) - base_end;
  }
  for (int i = 0; i < first; ++i) {
    for (int j = 0; j < paths.second; ++j) {
      const std::size_t k = at(i * paths.second + j);
      paths.start[k] = point_of(first_start, i) - point_of(second_start, j);
      paths.end[k] = point_of(first_end, i) - point_of(second_end, j);
    }
  }
  return paths;
}

int pair_count(const Paths& paths) {
  return paths.first * paths.second;
}

/// n . d, minus all that rounding (of d too) can have added.
double least_dot(const Vec3& n, const Vec3& d) {
  const double x = n.x() * d.x(), y = n.y() * d.y(), z = n.z() * d.z();
  return x + y + z - 8.0 * kUnit * (std::abs(x) + std::abs(y) + std::abs(z)) - kTiny;
}

/// Until when `direction` surely separates the features by more than `least`, if it does so at `time`; else
/// `time`. Along a fixed direction the separation of two vertices is linear in time: known at both ends, it
/// is known between them.
double separated_until(const Paths& paths, const Vec3& direction, double least, double time) {
  const double threshold = least * direction.norm() * (1.0 + 8.0 * kUnit);
  double until = 1.0;
  for (int k = 0; k < pair_count(paths); ++k) {
    const double start_dot = least_dot(direction, paths.start[at(k)]);
    const double end_dot = least_dot(direction, paths.end[at(k)]);
    const double slip = 8.0 * kUnit * (std::abs(start_dot) + std::abs(end_dot) + threshold) + kTiny;
    const double start = start_dot - threshold - slip, end = end_dot - threshold - slip;
    if (start > 0.0 && end > 0.0) continue;
    // (1 - time) start + time end > 0, rounding included.
    const double now = (1.0 - time) * start + time * end;
    if (!(now > 8.0 * kUnit * (std::abs(start) + std::abs(end)))) return time;
    if (end > 0.0) continue;  // opens: greater at all later times
    const double falls = start - end;
    until = std::min(until, start / falls * (1.0 - 16.0 * kUnit));
  }
  return std::max(until, time);
}

/// Both features at one time, seen from the last vertex.
struct Moment {
  std::array<Vec3, 4> points;
  std::array<Vec3, 2> edges{Vec3::Zero(),
                            Vec3::Zero()};  // on whose insides the closest points lie; 0: on none
  Vec3 direction =
      Vec3::Zero();       // between the closest points, from the second to the first, not of unit length
  double distance = 0.0;  // m
};

Moment look_at(const Paths& paths, double time) {
  Moment m;
  for (std::size_t i = 0; i < 4; ++i)
    m.points[i] = (1.0 - time) * paths.from_start[i] + time * paths.from_end[i];
  const auto& x = m.points;
  if (paths.first == 1) {
    const auto c = closest_on_triangle(x[0], x[1], x[2], x[3]);
    m.direction = x[0] - c.closest;
    for (int i = 0; i < 3; ++i)
      if (c.barycentric[i] == 0.0) m.edges[0] = x[at(1 + (i + 1) % 3)] - x[at(1 + (i + 2) % 3)];
    if ((c.barycentric.array() == 0.0).count() > 1) m.edges[0].setZero();
    m.distance = c.distance;
  } else {
    const auto c = closest_between_segments(x[0], x[1], x[2], x[3]);
    m.direction = c.on_p - c.on_q;
    if (c.s > 0.0 && c.s < 1.0) m.edges[0] = x[1] - x[0];
    if (c.t > 0.0 && c.t < 1.0) m.edges[1] = x[3] - x[2];
    m.distance = c.distance;
  }
  return m;
}

/// Unit length, or zero if it has none to speak of.
Vec3 unit_of(const Vec3& v) {
  const double size = v.cwiseAbs().maxCoeff();
  if (!(size > kTiny)) return Vec3::Zero();
  const Vec3 scaled = v / size;
  return scaled / scaled.norm();
}

/// The direction without its (rounded) parts along the edges that it should stand on.
Vec3 sharpened(const Moment& m) {
  Vec3 direction = unit_of(m.direction);
  for (int i = 0; i < 2; ++i) {
    for (const Vec3& edge : m.edges) {
      const Vec3 along = unit_of(edge);
      direction = unit_of(direction - direction.dot(along) * along);
    }
  }
  return direction;
}

/// Across the plane of the triangle, or of both edges; on the side of `like`.
Vec3 across(const Moment& m, int first, const Vec3& like) {
  const auto& x = m.points;
  const Vec3 normal =
      unit_of(first == 1 ? Vec3((x[2] - x[1]).cross(x[3] - x[1])) : Vec3((x[1] - x[0]).cross(x[3] - x[2])));
  return normal.dot(like) < 0.0 ? Vec3(-normal) : normal;
}

ContinuousResult follow(const Paths& paths, double least, double slack) {
  ContinuousResult result;
  double time = 0.0;
  Vec3 last = Vec3::Zero();
  while (result.iterations < kMostIterations) {
    const Moment now = look_at(paths, time);
    const Vec3 normal = unit_of(now.direction);
    result.distance = now.distance;
    result.normal = {normal.x(), normal.y(), normal.z()};
    double until = time;
    const auto try_along = [&](const Vec3& direction) {
      if (until >= 1.0 || direction.isZero(0.0)) return;
      ++result.iterations;
      const double reached = separated_until(paths, direction, least, time);
      if (reached <= until) return;
      until = reached;
      last = direction;
    };
    try_along(normal);
    if (until < 1.0) {
      // Where the distance is small its own direction is rough or noise: others still separate.
      try_along(sharpened(now));
      const Vec3 plane_normal = across(now, paths.first, normal);
      try_along(plane_normal);
      try_along(last);
      if (normal.isZero(0.0)) try_along(-plane_normal);
    }
    if (until >= 1.0) return result;
    if (until <= time || now.distance <= least + slack) break;
    time = until;
  }
  result.hit = true;
  result.time_of_impact = time;
  return result;
}

}  // namespace

ContinuousResult test_point_triangle(const double* point_start, const double* triangle_start,
                                     const double* point_end, const double* triangle_end,
                                     double least_separation, double slack) {
  return follow(make_paths(point_start, triangle_start, point_end, triangle_end, 1), least_separation, slack);
}

ContinuousResult test_edge_edge(const double* edge_a_start, const double* edge_b_start,
                                const double* edge_a_end, const double* edge_b_end, double least_separation,
                                double slack) {
  return follow(make_paths(edge_a_start, edge_b_start, edge_a_end, edge_b_end, 2), least_separation, slack);
}

}  // namespace shatterbox::geometry
