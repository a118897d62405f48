#include "engine/geometry/sheet_columns.h"

#include <algorithm>
#include <cmath>

#include "engine/core/index.h"

namespace shatterbox::geometry {
namespace {

using core::at;

constexpr double kLeastSquareness = 0.1;  // cosine

/// A cell as the lines see it.
struct CellShade {
  std::vector<Vec2> corners;
  Vec2 low = Vec2::Constant(1e300), high = Vec2::Constant(-1e300);
  Vec3 place = Vec3::Zero(), normal = Vec3::Zero();  // in the axes

  /// Convex, either way round. On its border: in one of the cells there, or in both.
  bool holds(const Vec2& p) const {
    if ((p - low).minCoeff() < 0.0 || (high - p).minCoeff() < 0.0) return false;
    bool is_left = false, is_right = false;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Vec2 side = corners[(i + 1) % corners.size()] - corners[i], way = p - corners[i];
      const double turn = side.x() * way.y() - side.y() * way.x();
      is_left = is_left || turn > 0.0;
      is_right = is_right || turn < 0.0;
    }
    return !(is_left && is_right);
  }
};

CellShade make_shade(const ShellMesh& mesh, const ShellCell& cell, const ColumnAxes& axes) {
  const auto in_axes = [&axes](const Vec3& v) {
    return Vec3(axes.first.dot(v), axes.second.dot(v), axes.along.dot(v));
  };
  CellShade shade;
  for (int i = 0; i < cell.corner_count; ++i) {
    const Vec3 corner = in_axes(position_in_element(*mesh.elements, cell.element,
                                                    mesh.corners[at(cell.first_corner + i)].barycentric));
    shade.place = corner;
    shade.corners.push_back(corner.head<2>());
    shade.low = shade.low.cwiseMin(corner.head<2>());
    shade.high = shade.high.cwiseMax(corner.head<2>());
  }
  shade.normal = in_axes(facet_frame(*mesh.elements, cell.element).col(2));
  return shade;
}

}  // namespace

std::vector<Column> find_columns(const ShellMesh& mesh, double thickness, const std::vector<int>& cells,
                                 const ColumnAxes& axes, const std::vector<Vec2>& places) {
  std::vector<CellShade> shades;
  for (const int c : cells) shades.push_back(make_shade(mesh, mesh.cells[at(c)], axes));
  std::vector<Column> columns(places.size());
  for (std::size_t p = 0; p < places.size(); ++p) {
    Column& column = columns[p];
    for (const CellShade& shade : shades) {
      if (!shade.holds(places[p])) continue;
      const double square = std::max(kLeastSquareness, std::abs(shade.normal.z()));
      const double length = thickness / square;
      const double lean = shade.normal.head<2>().dot(places[p] - shade.place.head<2>());
      const double middle = shade.place.z() - lean / std::copysign(square, shade.normal.z());
      if (!(column.length > 0.0) || middle - 0.5 * length < column.begin) {
        column.begin = middle - 0.5 * length;
        column.square_in = square;
      }
      if (!(column.length > 0.0) || middle + 0.5 * length > column.end) {
        column.end = middle + 0.5 * length;
        column.square_out = square;
      }
      column.length += length;
    }
  }
  return columns;
}

}  // namespace shatterbox::geometry
