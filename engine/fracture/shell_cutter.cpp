#include "engine/fracture/shell_cutter.h"

#include <algorithm>

#include "engine/core/index.h"
#include "engine/fracture/element_plane.h"

namespace shatterbox::fracture {
namespace {

using geometry::ShellCorner;
using geometry::SideKind;
using Size = std::size_t;
using core::at;

constexpr double kLeastPart = 1e-6;  // of an element's area

/// The corners from `a` counter-clockwise to `b`, closed by a side of the given kind.
std::vector<ShellCorner> part_between(const std::vector<ShellCorner>& polygon, const BorderPlace& a,
                                      const BorderPlace& b, SideKind kind, int side_id) {
  const int n = static_cast<int>(polygon.size());
  std::vector<ShellCorner> part;
  part.push_back({a.barycentric, polygon[at(a.side)].side, polygon[at(a.side)].side_id});
  int i = (a.side + 1) % n;
  const int stop = b.is_corner ? b.side : (b.side + 1) % n;
  // A chord between two points of one side has no corner in between on one hand and all of them on the other.
  for (int steps = 0; i != stop && steps < n; ++steps, i = (i + 1) % n) part.push_back(polygon[at(i)]);
  part.push_back({b.barycentric, kind, side_id});
  return part;
}

}  // namespace

double polygon_fraction(const std::vector<ShellCorner>& polygon) {
  double twice = 0.0;
  for (Size i = 1; i + 1 < polygon.size(); ++i)
    twice += cross(polygon[i].barycentric - polygon[0].barycentric,
                   polygon[i + 1].barycentric - polygon[0].barycentric);
  return twice;
}

ShellCutter::ShellCutter(const geometry::ShellMesh& mesh)
    : elements_(mesh.elements), of_element_(mesh.elements->mesh.triangles.size()) {
  cells_.reserve(mesh.cells.size() + mesh.cells.size() / 2);
  for (Size c = 0; c < mesh.cells.size(); ++c) {
    const geometry::ShellCell& cell = mesh.cells[c];
    CutCell cut{cell.element, static_cast<int>(c), cell.grain, {}};
    const auto first = mesh.corners.begin() + cell.first_corner;
    cut.polygon.assign(first, first + cell.corner_count);
    for (const ShellCorner& corner : cut.polygon)
      if (corner.side != SideKind::element_edge) next_side_id_ = std::max(next_side_id_, corner.side_id + 1);
    of_element_[at(cell.element)].push_back(static_cast<int>(c));
    cells_.push_back(std::move(cut));
  }
}

bool ShellCutter::cut(int number, const BorderPlace& a, const BorderPlace& b, SideKind kind, int side_id) {
  CutCell& cell = cells_[at(number)];
  if (!a.is_corner && !b.is_corner && a.side == b.side) return false;
  if (a.is_corner && b.is_corner && a.side == b.side) return false;
  std::vector<ShellCorner> left = part_between(cell.polygon, a, b, kind, side_id);
  std::vector<ShellCorner> right = part_between(cell.polygon, b, a, kind, side_id);
  if (left.size() < 3 || right.size() < 3) return false;
  if (polygon_fraction(left) < kLeastPart || polygon_fraction(right) < kLeastPart) return false;
  cell.polygon = std::move(left);
  CutCell other{cell.element, cell.origin, cell.grain, std::move(right)};
  of_element_[at(cell.element)].push_back(static_cast<int>(cells_.size()));
  cells_.push_back(std::move(other));
  return true;
}

void ShellCutter::replace(int number, std::vector<std::vector<ShellCorner>> parts) {
  const CutCell whole = cells_[at(number)];
  for (Size i = 0; i < parts.size(); ++i) {
    if (i == 0) {
      cells_[at(number)].polygon = std::move(parts[0]);
      continue;
    }
    of_element_[at(whole.element)].push_back(static_cast<int>(cells_.size()));
    cells_.push_back({whole.element, whole.origin, whole.grain, std::move(parts[i])});
  }
}

EdgeStretch ShellCutter::stretch(int number, int side) const {
  const CutCell& c = cells_[at(number)];
  const ShellCorner& from = c.polygon[at(side)];
  const ShellCorner& to = c.polygon[(at(side) + 1) % c.polygon.size()];
  const double p = edge_parameter(*elements_, c.element, from.side_id, from.barycentric);
  const double q = edge_parameter(*elements_, c.element, from.side_id, to.barycentric);
  return {number, side, std::min(p, q), std::max(p, q)};
}

std::optional<EdgeStretch> ShellCutter::find_stretch(int element, int edge, double parameter) const {
  for (const int number : of_element_[at(element)]) {
    const CutCell& c = cells_[at(number)];
    for (Size s = 0; s < c.polygon.size(); ++s) {
      if (c.polygon[s].side != SideKind::element_edge) continue;
      if (elements_->topology.triangle_edges[at(element)][at(c.polygon[s].side_id)] != edge) continue;
      const EdgeStretch found = stretch(number, static_cast<int>(s));
      if (found.begin < parameter && parameter < found.end) return found;
    }
  }
  return std::nullopt;
}

std::vector<double> ShellCutter::breaks_of_edge(int edge) const {
  std::vector<double> breaks;
  const geometry::EdgeTopology& topology = elements_->topology;
  for (int i = topology.first_triangle[at(edge)]; i < topology.first_triangle[at(edge) + 1]; ++i) {
    const int element = topology.edge_triangles[at(i)];
    for (const int number : of_element_[at(element)]) {
      const CutCell& c = cells_[at(number)];
      for (Size s = 0; s < c.polygon.size(); ++s) {
        if (c.polygon[s].side != SideKind::element_edge) continue;
        if (topology.triangle_edges[at(element)][at(c.polygon[s].side_id)] != edge) continue;
        const EdgeStretch found = stretch(number, static_cast<int>(s));
        for (const double q : {found.begin, found.end})
          if (q > 0.0 && q < 1.0) breaks.push_back(q);
      }
    }
  }
  std::sort(breaks.begin(), breaks.end());
  breaks.erase(std::unique(breaks.begin(), breaks.end()), breaks.end());
  return breaks;
}

int ShellCutter::find_cell(int element, const Vec2& barycentric) const {
  for (const int number : of_element_[at(element)]) {
    const std::vector<ShellCorner>& polygon = cells_[at(number)].polygon;
    bool is_inside = true;
    for (Size s = 0; s < polygon.size() && is_inside; ++s) {
      const Vec2& from = polygon[s].barycentric;
      is_inside = cross(polygon[(s + 1) % polygon.size()].barycentric - from, barycentric - from) >= 0.0;
    }
    if (is_inside) return number;
  }
  return -1;
}

geometry::ShellMesh ShellCutter::mesh(std::vector<geometry::CellContact>* contacts) const {
  geometry::ShellMesh mesh;
  mesh.elements = elements_;
  mesh.cells.reserve(cells_.size());
  for (Size element = 0; element < of_element_.size(); ++element) {
    if (of_element_[element].empty()) continue;
    const double area = element_area(*elements_, static_cast<int>(element));
    for (const int number : of_element_[element]) {
      const CutCell& cut = cells_[at(number)];
      geometry::ShellCell cell;
      cell.element = cut.element;
      cell.grain = cut.grain;
      cell.area = area * polygon_fraction(cut.polygon);
      cell.first_corner = static_cast<int>(mesh.corners.size());
      cell.corner_count = static_cast<int>(cut.polygon.size());
      mesh.corners.insert(mesh.corners.end(), cut.polygon.begin(), cut.polygon.end());
      mesh.cells.push_back(cell);
    }
  }
  std::vector<geometry::CellContact> found = find_cell_contacts(mesh);
  assign_degrees_of_freedom(mesh, found);
  if (contacts) *contacts = std::move(found);
  return mesh;
}

}  // namespace shatterbox::fracture
