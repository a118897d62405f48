#include "engine/fracture/striker_way.h"

#include <algorithm>

#include "engine/core/elementary.h"
#include "engine/core/index.h"
#include "engine/geometry/sheet_columns.h"
#include "engine/geometry/solid_columns.h"

namespace shatterbox::fracture {
namespace {

using core::at;

constexpr int kPunchSides = 24;         // of a round hole; at most so many of any
constexpr double kLeastTurn = 1e-5;     // rad, between two sides
constexpr double kLeastSection = 1e-9;  // of the square of its reach: what is less is a line
constexpr int kSectionRings = 8;        // of places over a section, all of one area
constexpr int kRimPlaces = 96;          // about, along its rim, and on each ring

Vec2 normal_at(double angle) {
  const core::SinCos turned = core::sin_cos(angle);
  return {turned.cos, turned.sin};
}

/// Directions of the hole's sides, by angle: those of the core's own sides, and about its round ones as many
/// more as make a circle of kPunchSides.
std::vector<Vec2> side_normals(const Striker& striker) {
  std::vector<double> angles;
  const std::size_t n = striker.core.size();
  if (n > 1 && n <= static_cast<std::size_t>(kPunchSides))
    for (std::size_t i = 0; i < n; ++i) {
      const Vec2 side = striker.core[(i + 1) % n] - striker.core[i];
      angles.push_back(core::atan2(-side.x(), side.y()));
    }
  const double step = 2.0 * core::kPi / kPunchSides;
  if (angles.empty()) {
    for (int i = 0; i < kPunchSides; ++i) angles.push_back(step * i);
  } else if (striker.radius > 0.0) {
    std::sort(angles.begin(), angles.end());
    const std::size_t given = angles.size();
    for (std::size_t i = 0; i < given; ++i) {
      const double gap = i + 1 < given ? angles[i + 1] - angles[i] : angles[0] + 2.0 * core::kPi - angles[i];
      const int parts = static_cast<int>(gap / step + 0.5);
      for (int k = 1; k < parts; ++k) angles.push_back(angles[i] + gap * k / parts);
    }
  }
  std::sort(angles.begin(), angles.end());
  std::vector<Vec2> normals;
  // One side in two parts is one.
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const double next = i + 1 < angles.size() ? angles[i + 1] : angles.front() + 2.0 * core::kPi;
    if (next - angles[i] > kLeastTurn) normals.push_back(normal_at(angles[i]));
  }
  return normals;
}

double support_of_core(const Striker& striker, const Vec2& normal) {
  double most = -1e300;
  for (const Vec2& corner : striker.core) most = std::max(most, normal.dot(corner));
  return most + striker.radius;
}

/// The section with straight sides, wider by `clearance` m: its corners, counter-clockwise.
std::vector<Vec2> corners_of_section(const Striker& striker, double clearance) {
  const std::vector<Vec2> normals = side_normals(striker);
  std::vector<Vec2> corners;
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const Vec2 &a = normals[i], &b = normals[(i + 1) % normals.size()];
    const double reach_a = support_of_core(striker, a) + clearance;
    const double reach_b = support_of_core(striker, b) + clearance;
    const double sine = a.x() * b.y() - a.y() * b.x();
    corners.push_back(Vec2(reach_a * b.y() - reach_b * a.y(), reach_b * a.x() - reach_a * b.x()) / sine);
  }
  return corners;
}

/// What of a convex polygon lies in the half plane normal . x <= limit.
std::vector<Vec2> clip(const std::vector<Vec2>& corners, const Vec2& normal, double limit) {
  std::vector<Vec2> left;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec2 &a = corners[i], &b = corners[(i + 1) % corners.size()];
    const double over_a = normal.dot(a) - limit, over_b = normal.dot(b) - limit;
    if (over_a <= 0.0) left.push_back(a);
    if ((over_a < 0.0 && over_b > 0.0) || (over_a > 0.0 && over_b < 0.0))
      left.push_back(a + over_a / (over_a - over_b) * (b - a));
  }
  return left;
}

double area_of(const std::vector<Vec2>& corners) {
  double area = 0.0;
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    const Vec2 a = corners[i] - corners[0], b = corners[i + 1] - corners[0];
    area += 0.5 * (a.x() * b.y() - a.y() * b.x());
  }
  return area;
}

/// Places, and what share of all each stands for.
struct SharedPlaces {
  std::vector<Vec2> places;
  std::vector<double> shares;
};

/// Along a convex polygon.
SharedPlaces places_along(const std::vector<Vec2>& corners) {
  double length = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i)
    length += (corners[(i + 1) % corners.size()] - corners[i]).norm();
  SharedPlaces out;
  if (!(length > 0.0)) return out;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec2 side = corners[(i + 1) % corners.size()] - corners[i];
    const double share = side.norm() / length;
    const int count = std::max(1, static_cast<int>(share * kRimPlaces + 0.5));
    for (int k = 0; k < count; ++k) {
      out.places.push_back(corners[i] + (k + 0.5) / count * side);
      out.shares.push_back(share / count);
    }
  }
  return out;
}

/// Over a convex polygon: rings of equal area about its middle, each cut as its rim is.
SharedPlaces places_over(const std::vector<Vec2>& corners) {
  SharedPlaces out;
  if (corners.size() < 3) return out;
  Vec2 middle = Vec2::Zero();
  for (const Vec2& corner : corners) middle += corner / static_cast<double>(corners.size());
  const double area = area_of(corners);
  double reach = 0.0;
  for (const Vec2& corner : corners) reach = std::max(reach, (corner - middle).squaredNorm());
  if (!(area > kLeastSection * reach)) return out;  // clipped to a line
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec2 &a = corners[i], &b = corners[(i + 1) % corners.size()];
    const int count = std::max(1, static_cast<int>(area_of({middle, a, b}) / area * kRimPlaces + 0.5));
    for (int k = 0; k < count; ++k)
      for (int ring = 0; ring < kSectionRings; ++ring) {
        const Vec2 arm = a + (k + 0.5) / count * (b - a) - middle;
        out.places.push_back(middle + core::sqrt((ring + 0.5) / kSectionRings) * arm);
        out.shares.push_back(area_of({middle, a, b}) / (area * count * kSectionRings));
      }
  }
  return out;
}

/// What of the section corners of elements reach around; all from the striker's centre.
std::vector<Vec2> clip_to_points(std::vector<Vec2> corners, const std::vector<Vec3>& points,
                                 const Striker& striker) {
  for (const Vec2& normal : {Vec2(1, 0), Vec2(-1, 0), Vec2(0, 1), Vec2(0, -1)}) {
    const Vec3 across = normal.x() * striker.first + normal.y() * striker.second;
    double most = -1e300;
    for (const Vec3& point : points) most = std::max(most, across.dot(point - striker.centre));
    corners = clip(corners, normal, most);
  }
  return corners;
}

/// `points`: corners of elements that hold all of the material. `columns_at`: of places from the axes'
/// origin.
template <class ColumnsAt>
WayMaterial measure_way(const Striker& striker, double clearance, const std::vector<Vec3>& points,
                        const ColumnsAt& columns_at_origin) {
  const Vec2 centre(striker.first.dot(striker.centre), striker.second.dot(striker.centre));
  const auto columns_at = [&](std::vector<Vec2> places) {
    for (Vec2& place : places) place += centre;
    return columns_at_origin(places);
  };
  const std::vector<Vec2> section = corners_of_section(striker, 0.0);
  const std::vector<Vec2> reached = clip_to_points(section, points, striker);
  const double reached_share = area_of(reached) / area_of(section);
  const SharedPlaces inner = places_over(reached), rim = places_along(section);
  WayMaterial way;
  way.front = 1e300;
  double met = 0.0;  // of the section
  const std::vector<geometry::Column> columns = columns_at(inner.places);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const double share = reached_share * inner.shares[i];
    way.section.push_back({columns[i].length, share});
    way.thickness += share * columns[i].length;
    if (!(columns[i].length > 0.0)) continue;
    way.front = std::min(way.front, columns[i].begin);
    way.squareness += share * 0.5 * (columns[i].square_in + columns[i].square_out);
    met += share;
  }
  if (met > 0.0) way.squareness /= met;
  const std::vector<geometry::Column> wall = columns_at(rim.places);
  for (std::size_t i = 0; i < wall.size(); ++i) way.rim.push_back({wall[i].length, rim.shares[i]});
  // The clearance is cut, too.
  for (const geometry::Column& column :
       columns_at(places_along(corners_of_section(striker, clearance)).places))
    if (column.length > 0.0) way.front = std::min(way.front, column.begin);
  return way;
}

}  // namespace

std::vector<geometry::PunchSide> sides_of_way(const Striker& striker, double clearance, double taper,
                                              double front) {
  std::vector<geometry::PunchSide> sides;
  for (const Vec2& normal : side_normals(striker)) {
    const Vec3 across = normal.x() * striker.first + normal.y() * striker.second;
    const double reach = across.dot(striker.centre) + support_of_core(striker, normal) + clearance;
    sides.push_back({across - taper * striker.direction, reach - taper * front});
  }
  return sides;
}

WayMaterial find_way_material(const geometry::SolidComplex& complex, const std::vector<int>& cells,
                              const Striker& striker, double clearance) {
  const geometry::TetMesh& mesh = complex.elements->mesh;
  std::vector<Vec3> points;
  for (const int c : cells)
    for (const int v : mesh.tetrahedra[at(complex.cells[at(c)].element)])
      points.push_back(mesh.positions[at(v)]);
  const geometry::ColumnAxes axes{striker.first, striker.second, striker.direction};
  return measure_way(striker, clearance, points, [&](const std::vector<Vec2>& places) {
    return geometry::find_columns(complex, cells, axes, places);
  });
}

WayMaterial find_way_material(const geometry::ShellMesh& mesh, double thickness,
                              const std::vector<int>& cells, const Striker& striker, double clearance) {
  const geometry::TriangleMesh& elements = mesh.elements->mesh;
  std::vector<Vec3> points;
  for (const int c : cells)
    for (const int v : elements.triangles[at(mesh.cells[at(c)].element)])
      points.push_back(elements.positions[at(v)]);
  const geometry::ColumnAxes axes{striker.first, striker.second, striker.direction};
  return measure_way(striker, clearance, points, [&](const std::vector<Vec2>& places) {
    return geometry::find_columns(mesh, thickness, cells, axes, places);
  });
}

}  // namespace shatterbox::fracture
