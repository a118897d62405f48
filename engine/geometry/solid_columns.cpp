#include "engine/geometry/solid_columns.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/core/index.h"

namespace shatterbox::geometry {
namespace {

using core::at;

constexpr double kSlack = 1e-6;  // of a facet's size, beyond which it is surely passed by

/// A facet of the border as the lines see it.
struct FacetShade {
  std::vector<std::pair<Vec2, Vec2>> sides;  // both facets at an edge have its ends in one order
  Vec2 low = Vec2::Constant(1e300), high = Vec2::Constant(-1e300);
  double shallowest = 1e300, deepest = -1e300;        // m, along the lines
  Vec3 centre = Vec3::Zero(), normal = Vec3::Zero();  // in the axes; the normal points out of the material
};

Vec3 in_axes(const ColumnAxes& axes, const Vec3& v) {
  return {axes.first.dot(v), axes.second.dot(v), axes.along.dot(v)};
}

FacetShade make_shade(const SolidComplex& complex, const SolidFacet& facet, const ColumnAxes& axes,
                      bool is_behind) {
  FacetShade shade;
  for (int k = 0; k < facet.side_count; ++k) {
    const SolidEdge& edge = complex.edges[at(complex.sides_of(facet)[k] / 2)];
    const Vec3 a = in_axes(axes, complex.position(edge.ends[0]));
    const Vec3 b = in_axes(axes, complex.position(edge.ends[1]));
    shade.sides.emplace_back(a.head<2>(), b.head<2>());
    for (const Vec3& end : {a, b}) {
      shade.low = shade.low.cwiseMin(end.head<2>());
      shade.high = shade.high.cwiseMax(end.head<2>());
      shade.shallowest = std::min(shade.shallowest, end.z());
      shade.deepest = std::max(shade.deepest, end.z());
      shade.centre += end / (2.0 * facet.side_count);
    }
  }
  const double sign = is_behind ? 1.0 : -1.0;
  shade.normal = sign * in_axes(axes, facet_area_vector(complex, facet)).normalized();
  return shade;
}

/// The facets between these cells and all else.
std::vector<FacetShade> find_border(const SolidComplex& complex, const std::vector<int>& cells,
                                    const ColumnAxes& axes) {
  std::vector<char> is_in(complex.cells.size(), 0);
  for (const int c : cells) is_in[at(c)] = 1;
  const auto holds = [&is_in](int cell) { return cell >= 0 && is_in[at(cell)] != 0; };
  std::vector<FacetShade> border;
  for (const int c : cells) {
    const SolidPart& part = complex.cells[at(c)];
    for (int f = 0; f < part.facet_count; ++f) {
      const SolidFacet& facet = complex.facets[at(complex.cell_facets[at(part.first_facet + f)] / 2)];
      if (holds(facet.cells[0]) != holds(facet.cells[1]))
        border.push_back(make_shade(complex, facet, axes, holds(facet.cells[0])));
    }
  }
  return border;
}

/// By crossings to one side, half open: of facets that share an edge, one has a line through it.
bool is_over(const FacetShade& shade, const Vec2& place) {
  // Of rounding at a side's end both facets there must say the same.
  const double slack = kSlack * (shade.high - shade.low).maxCoeff();
  if (place.x() < shade.low.x() - slack || place.x() > shade.high.x() + slack || place.y() < shade.low.y() ||
      place.y() > shade.high.y())
    return false;
  bool is_inside = false;
  for (const auto& [a, b] : shade.sides) {
    if ((a.y() > place.y()) == (b.y() > place.y())) continue;
    const double x = a.x() + (place.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
    if (place.x() < x) is_inside = !is_inside;
  }
  return is_inside;
}

double depth_at(const FacetShade& shade, const Vec2& place) {
  const Vec2 arm = place - shade.centre.head<2>();
  if (shade.normal.z() == 0.0) return shade.centre.z();
  return std::clamp(shade.centre.z() - shade.normal.head<2>().dot(arm) / shade.normal.z(), shade.shallowest,
                    shade.deepest);
}

}  // namespace

std::vector<Column> find_columns(const SolidComplex& complex, const std::vector<int>& cells,
                                 const ColumnAxes& axes, const std::vector<Vec2>& places) {
  const std::vector<FacetShade> border = find_border(complex, cells, axes);
  std::vector<Column> columns;
  columns.reserve(places.size());
  for (const Vec2& place : places) {
    Column column;
    column.begin = 1e300;
    column.end = -1e300;
    for (const FacetShade& shade : border) {
      if (!is_over(shade, place)) continue;
      const double depth = depth_at(shade, place), square = std::abs(shade.normal.z());
      const bool is_exit = shade.normal.z() > 0.0;
      column.length += is_exit ? depth : -depth;
      if (!is_exit && depth < column.begin) {
        column.begin = depth;
        column.square_in = square;
      }
      if (is_exit && depth > column.end) {
        column.end = depth;
        column.square_out = square;
      }
    }
    columns.push_back(column.length > 0.0 && column.begin < column.end ? column : Column{});
  }
  return columns;
}

}  // namespace shatterbox::geometry
