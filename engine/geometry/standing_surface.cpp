#include "engine/geometry/standing_surface.h"

#include "engine/core/index.h"
#include "engine/geometry/closest_points.h"
#include "engine/geometry/shell_surface.h"

namespace shatterbox::geometry {
namespace {

using Size = std::size_t;
using core::at;

constexpr double kOnFace = 1e-9;  // of an element: as far as a point of a face may lie beside it

double cross_of(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Barycentric weights' distance of a point to the left of a polygon's side.
double inside_side(const ShellMesh& mesh, const ShellCell& cell, int side, const Vec2& point) {
  const Vec2& from = mesh.corners[at(cell.first_corner + side)].barycentric;
  const Vec2 along = mesh.corners[at(cell.first_corner + (side + 1) % cell.corner_count)].barycentric - from;
  const double length = along.norm();
  return length > 0.0 ? cross_of(along, point - from) / length : 0.0;
}

}  // namespace

StandingSurface::StandingSurface(const ShellMesh& mesh, std::vector<Vec3> placed)
    : mesh_(mesh),
      placed_(std::move(placed)),
      element_cells_(mesh.elements->mesh.triangles.size()),
      vertex_elements_(mesh.elements->mesh.positions.size()),
      cell_triangles_(mesh.cells.size()) {
  for (Size c = 0; c < mesh.cells.size(); ++c)
    element_cells_[at(mesh.cells[c].element)].push_back(static_cast<int>(c));
  for (Size e = 0; e < element_cells_.size(); ++e)
    for (const int v : mesh.elements->mesh.triangles[e])
      if (!element_cells_[e].empty()) vertex_elements_[at(v)].push_back(static_cast<int>(e));
  const ShellSurface material = extract_surface(mesh, 0.0);
  for (Size t = 0; t < material.mesh.triangles.size(); ++t) {
    Fold fold{material.mesh.triangles[t], {}};
    for (Size i = 0; i < 3; ++i) fold.corners[i] = material.mesh.positions[at(fold.vertices[i])];
    cell_triangles_[at(material.triangle_cells[t])].push_back(fold);
  }
}

int StandingSurface::cell_at(int element, const Vec2& barycentric) const {
  int found = -1;
  double deepest = -1e300;
  for (const int number : element_cells_[at(element)]) {
    const ShellCell& cell = mesh_.cells[at(number)];
    double depth = 1e300;
    for (int s = 0; s < cell.corner_count; ++s)
      depth = std::min(depth, inside_side(mesh_, cell, s, barycentric));
    if (depth <= deepest) continue;
    deepest = depth;
    found = number;
  }
  return found;
}

Vec3 StandingSurface::place(int cell, const Vec3& point) const {
  Vec3 place = point;
  double nearest = 1e300;
  for (const Fold& fold : cell_triangles_[at(cell)]) {
    const PointTriangle found = closest_on_triangle(point, fold.corners[0], fold.corners[1], fold.corners[2]);
    if (found.distance >= nearest) continue;
    nearest = found.distance;
    place.setZero();
    for (int i = 0; i < 3; ++i) place += found.barycentric[i] * placed_[at(fold.vertices[at(i)])];
  }
  return place;
}

bool StandingSurface::holds(int element, const Vec3& place, double tolerance) const {
  const auto is_on = [&](int cell) {
    for (const Fold& fold : cell_triangles_[at(cell)]) {
      const auto& [i, j, k] = fold.vertices;
      if (closest_on_triangle(place, placed_[at(i)], placed_[at(j)], placed_[at(k)]).distance <= tolerance)
        return true;
    }
    return false;
  };
  for (const int cell : element_cells_[at(element)])
    if (is_on(cell)) return true;
  for (const int v : mesh_.elements->mesh.triangles[at(element)])
    for (const int beside : vertex_elements_[at(v)])
      for (const int cell : element_cells_[at(beside)])
        if (beside != element && is_on(cell)) return true;
  return false;
}

bool StandingSurface::is_on_crack(int cell, int side_id, const Vec2& barycentric) const {
  const ShellCell& own = mesh_.cells[at(cell)];
  for (int s = 0; s < own.corner_count; ++s) {
    const ShellCorner& from = mesh_.corners[at(own.first_corner + s)];
    if (from.side != SideKind::crack || from.side_id != side_id) continue;
    const Vec2 along =
        mesh_.corners[at(own.first_corner + (s + 1) % own.corner_count)].barycentric - from.barycentric;
    const double share = along.dot(barycentric - from.barycentric) / along.squaredNorm();
    if (share > -kOnFace && share < 1.0 + kOnFace &&
        std::abs(inside_side(mesh_, own, s, barycentric)) < kOnFace)
      return true;
  }
  return false;
}

}  // namespace shatterbox::geometry
