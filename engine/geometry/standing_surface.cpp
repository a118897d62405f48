#include "engine/geometry/standing_surface.h"

#include <algorithm>

#include "engine/core/index.h"
#include "engine/geometry/closest_points.h"
#include "engine/geometry/shell_surface.h"

namespace shatterbox::geometry {
namespace {

using Size = std::size_t;
using core::at;

constexpr double kOnFace = 1e-9;       // of an element: as far as a point of a face may lie beside it
constexpr double kNoCrossing = 1e-12;  // sine of an angle at which lines have no place where they cross

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

/// Marks, of the places of a course between two of them, those without which it would be off by more than
/// `tolerance`; each is a share of the way.
void keep_bends(const std::vector<double>& shares, const std::vector<Vec3>& places, double tolerance,
                Size first, Size last, std::vector<char>& is_kept) {
  Size furthest = first;
  double most = tolerance;
  for (Size k = first + 1; k < last; ++k) {
    const double share = (shares[k] - shares[first]) / (shares[last] - shares[first]);
    const double off = (places[k] - places[first] - share * (places[last] - places[first])).norm();
    if (!(off > most)) continue;
    most = off;
    furthest = k;
  }
  if (furthest == first) return;
  is_kept[furthest] = 1;
  keep_bends(shares, places, tolerance, first, furthest, is_kept);
  keep_bends(shares, places, tolerance, furthest, last, is_kept);
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

int StandingSurface::cell_of(const ShellMesh& piece, const ShellCell& cell) const {
  Vec2 middle = Vec2::Zero();
  for (int i = 0; i < cell.corner_count; ++i) middle += piece.corners[at(cell.first_corner + i)].barycentric;
  return cell_at(cell.element, middle / cell.corner_count);
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

std::vector<double> StandingSurface::find_folds_across(int cell, const Vec3& begin, const Vec3& end) const {
  const Mat3 frame = facet_frame(*mesh_.elements, mesh_.cells[at(cell)].element);
  const auto flat = [&](const Vec3& v) { return Vec2(frame.col(0).dot(v), frame.col(1).dot(v)); };
  const Vec2 along = flat(end - begin);
  std::vector<double> shares = {0.0, 1.0};
  for (const Fold& fold : cell_triangles_[at(cell)])
    for (Size i = 0; i < 3; ++i) {
      const Vec2 corner = flat(fold.corners[i] - begin),
                 side = flat(fold.corners[(i + 1) % 3] - fold.corners[i]);
      const double across = cross_of(along, side);
      if (!(std::abs(across) > kNoCrossing * along.norm() * side.norm())) continue;
      const double share = cross_of(corner, side) / across, on_side = cross_of(corner, along) / across;
      if (share > 0.0 && share < 1.0 && on_side >= 0.0 && on_side <= 1.0) shares.push_back(share);
    }
  std::sort(shares.begin(), shares.end());
  shares.erase(std::unique(shares.begin(), shares.end()), shares.end());
  return shares;
}

std::vector<Vec2> StandingSurface::find_bends(int cell, const Vec2& from, const Vec2& to,
                                              double tolerance) const {
  const int element = mesh_.cells[at(cell)].element;
  const Vec3 begin = position_in_element(*mesh_.elements, element, from),
             end = position_in_element(*mesh_.elements, element, to);
  // Affine in each triangle, it bends only where it goes from one to the next.
  const std::vector<double> shares = find_folds_across(cell, begin, end);
  std::vector<Vec3> places;
  for (const double share : shares) places.push_back(place(cell, begin + share * (end - begin)));
  std::vector<char> is_kept(shares.size(), 0);
  is_kept.back() = 1;
  keep_bends(shares, places, tolerance, 0, shares.size() - 1, is_kept);
  std::vector<Vec2> bends;
  Size last = 0;
  for (Size k = 1; k < shares.size(); ++k) {
    if (!is_kept[k]) continue;
    // Beside slivers the surface may stand folded over: what runs to and fro there has no better course.
    if (!((places[k] - places[last]).dot(places.back() - places.front()) > 0.0)) return {};
    last = k;
    bends.push_back(from + shares[k] * (to - from));
  }
  bends.pop_back();  // the end
  return bends;
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

ShellMesh divide_at_bends(const ShellMesh& piece, const StandingSurface& whole, double tolerance) {
  ShellMesh out = piece;
  out.corners.clear();
  for (Size c = 0; c < piece.cells.size(); ++c) {
    const ShellCell& cell = piece.cells[c];
    const int standing = whole.cell_of(piece, cell);
    out.cells[c].first_corner = static_cast<int>(out.corners.size());
    for (int s = 0; s < cell.corner_count; ++s) {
      const ShellCorner& from = piece.corners[at(cell.first_corner + s)];
      const ShellCorner& to = piece.corners[at(cell.first_corner + (s + 1) % cell.corner_count)];
      out.corners.push_back(from);
      const Vec2 middle = 0.5 * (from.barycentric + to.barycentric);
      if (from.side != SideKind::crack || standing < 0 || whole.is_on_crack(standing, from.side_id, middle))
        continue;
      for (const Vec2& bend : whole.find_bends(standing, from.barycentric, to.barycentric, tolerance))
        out.corners.push_back({bend, from.side, from.side_id});
    }
    out.cells[c].corner_count = static_cast<int>(out.corners.size()) - out.cells[c].first_corner;
  }
  return out;
}

}  // namespace shatterbox::geometry
