// What is turned on a lathe: a profile of points, corner by corner or as a smooth curve.
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/geometry/closest_points.h"
#include "engine/geometry/generator_faults.h"
#include "engine/geometry/generators.h"
#include "engine/geometry/plane_lines.h"

namespace shatterbox::geometry {
namespace {

using Points = std::vector<Vec2>;

bool is_between(const Vec2& p, const Vec2& a, const Vec2& b) {
  return turn(a, b, p) == 0.0 && (p - a).dot(p - b) <= 0.0;
}

/// Crossed, or touching.
bool do_meet(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  return do_cross(a, b, c, d) || is_between(a, c, d) || is_between(b, c, d) || is_between(c, a, b) ||
         is_between(d, a, b);
}

bool ends_where_it_begins(const Points& points) {
  return points.size() > 3 && points.front() == points.back() && points.front().x() > 0.0;
}

std::string number(std::size_t i) {
  return std::to_string(i + 1);
}

/// Whether lines i and j > i, from those points on, meet elsewhere than where one ends and the next begins.
bool do_lines_meet(const Points& points, std::size_t i, std::size_t j) {
  if (j == i + 1)
    return is_between(points[j + 1], points[i], points[j]) || is_between(points[i], points[j], points[j + 1]);
  const bool close_ring = i == 0 && j + 2 == points.size() && ends_where_it_begins(points);
  return !close_ring && do_meet(points[i], points[i + 1], points[j], points[j + 1]);
}

std::optional<std::string> find_crossing(const Points& points) {
  for (std::size_t j = 1; j + 1 < points.size(); ++j)
    for (std::size_t i = 0; i < j; ++i)
      if (do_lines_meet(points, i, j))
        return "a lathe's profile meets itself: its lines from point " + number(i) + " and from point " +
               number(j);
  return std::nullopt;
}

/// Twice the area between the profile and the axis, m2: negative if it goes down outside.
double area_outside(const Points& points) {
  double area = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i)
    area += (points[i - 1].x() + points[i].x()) * (points[i].y() - points[i - 1].y());
  return area;
}

/// How thin it is, m: how near lines are that go the other way. 1e300: no two do.
double find_wall(const Points& points) {
  const auto lifted = [](const Vec2& p) { return Vec3(p.x(), p.y(), 0.0); };
  double wall = 1e300;
  for (std::size_t i = 1; i < points.size(); ++i) {
    for (std::size_t j = i + 2; j < points.size(); ++j) {
      const Vec2 &a = points[i - 1], &b = points[i], &c = points[j - 1], &d = points[j];
      if ((b - a).dot(d - c) >= 0.0 || a == d) continue;
      wall = std::min(wall, closest_between_segments(lifted(a), lifted(b), lifted(c), lifted(d)).distance);
    }
  }
  return wall;
}

std::vector<ProfileSegment> cornered(const Points& points) {
  std::vector<ProfileSegment> profile;
  for (std::size_t i = 1; i < points.size(); ++i)
    profile.push_back({ProfileSegment::Kind::line, points[i - 1], points[i], Vec2::Zero(), Part::body});
  return profile;
}

/// The quadratic B-spline of the points: parabolas from the middle of one line to that of the next.
std::vector<ProfileSegment> rounded(const Points& points) {
  if (points.size() == 2) return cornered(points);
  const auto middle = [&](std::size_t i) { return Vec2(0.5 * (points[i] + points[i + 1])); };
  const bool is_round = ends_where_it_begins(points);
  const std::size_t last = points.size() - 1;
  std::vector<ProfileSegment> profile;
  const auto add = [&](const Vec2& from, const Vec2& control, const Vec2& to) {
    profile.push_back({ProfileSegment::Kind::parabola, from, to, control, Part::body});
  };
  for (std::size_t i = 1; i < last; ++i)
    add(i == 1 && !is_round ? points[0] : middle(i - 1), points[i],
        i + 1 == last && !is_round ? points[last] : middle(i));
  if (is_round) add(middle(last - 1), points[0], middle(0));
  return profile;
}

}  // namespace

std::optional<std::string> find_fault(const LatheSizes& sizes) {
  const Points& points = sizes.profile;
  if (points.size() < 2) return "a lathe's profile needs at least two points";
  double most = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::string name = "point " + number(i) + " of a lathe's profile ";
    if (!(std::isfinite(points[i].x()) && std::isfinite(points[i].y()) && points[i].norm() < 1e9))
      return name + "is nowhere";
    if (points[i].x() < 0.0) return name + "is on the other side of the axis: its radius is negative";
    if (points[i].x() == 0.0 && i > 0 && i + 1 < points.size())
      return name + "is on the axis; only the first and the last may be there";
    if (i > 0 && points[i] == points[i - 1]) return name + "is where the one before it is";
    most = std::max(most, points[i].x());
  }
  if (most == 0.0) return "a lathe's profile has no radius: all its points are on the axis";
  if (auto crossing = find_crossing(points)) return crossing;
  if (sizes.is_closed && area_outside(points) == 0.0) return "a lathe's profile has nothing inside";
  return std::nullopt;
}

core::Result<TriangleMesh> make_lathe(const LatheSizes& sizes, const Meshing& wanted) {
  if (const auto fault = find_fault(sizes)) return core::Error{*fault};
  Points points = sizes.profile;
  if (area_outside(points) < 0.0) std::reverse(points.begin(), points.end());
  std::vector<ProfileSegment> profile = sizes.is_smooth ? rounded(points) : cornered(points);
  const auto line = [](const Vec2& from, const Vec2& to) {
    return ProfileSegment{ProfileSegment::Kind::line, from, to, Vec2::Zero(), Part::body};
  };
  if (sizes.is_closed && !ends_where_it_begins(points)) {
    const Vec2 from = profile.front().from, to = profile.back().to;
    if (from.x() > 0.0) profile.insert(profile.begin(), line({0.0, from.y()}, from));
    if (to.x() > 0.0) profile.push_back(line(to, {0.0, to.y()}));
  }
  Meshing meshing = wanted;
  const double wall = sizes.is_closed ? find_wall(points) : 1e300;
  meshing.edge_length = std::min(meshing.edge_length, 2.0 * wall);
  core::Result<PartedMesh> turned = make_surface_of_revolution(profile, meshing);
  if (!turned && meshing.edge_length < wanted.edge_length)
    return core::Error{"a lathe's wall of " + metres(wall) + " would need more than " +
                       std::to_string(kMostTriangles) +
                       " triangles: make it thicker, or a shell of that thickness"};
  if (!turned) return core::Error{turned.error()};
  return std::move(turned.value().mesh);
}

}  // namespace shatterbox::geometry
