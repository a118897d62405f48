#include "engine/geometry/shell_surface.h"

#include <algorithm>
#include <functional>
#include <memory>
#include <numeric>

#include "engine/core/disjoint_sets.h"
#include "engine/core/index.h"
#include "engine/geometry/ear_clipping.h"
#include "engine/geometry/shell_kerf.h"
#include "engine/geometry/standing_surface.h"

namespace shatterbox::geometry {
namespace {

using Size = std::size_t;
using core::at;

constexpr double kBeside = 1e-6;  // of a kerf: as far as rounding may lead out of the whole
constexpr double kStood = 0.5;    // of a kerf: what stands nearer to its crack has to stand back anew
constexpr double kTouch = 1e-6;   // share of an edge that counts as contact, as in find_cell_contacts

/// A point on the border of a cell's polygon: a corner, or a place where a neighbour has a corner.
struct BorderPoint {
  Vec2 barycentric;
  int side;    // that leaves it
  double key;  // along the side, for the order of points on it
};

/// A polygon's side on an element's edge, or on a closed facet (then `edge` is -1 and positions are
/// compared).
struct SideStretch {
  int edge, cell, side;
  double begin, end;  // parameters along the edge
  bool is_forward;    // the side runs from begin to end
};

class SurfaceBuilder {
 public:
  SurfaceBuilder(const ShellMesh& mesh, const StandingSurface* whole)
      : mesh_(mesh), elements_(*mesh.elements), whole_(whole) {}

  ShellSurface build(double kerf) {
    if (whole_) find_cells_of_whole();
    collect_stretches();
    insert_neighbours_corners();
    number_nodes();
    weld();
    number_vertices();
    place_vertices();
    for (Size c = 0; c < mesh_.cells.size(); ++c) triangulate_cell(static_cast<int>(c));
    surface_.least_kerf =
        kerf > 0.0 ? stand_back(surface_.mesh, triangle_normals(), collect_normals(kerf), kerf, within(kerf))
                   : kerf;
    return std::move(surface_);
  }

 private:
  const ShellCorner& corner(const ShellCell& cell, int i) const {
    return mesh_.corners[at(cell.first_corner + (i % cell.corner_count))];
  }

  /// Whether a place beside a triangle is of the whole; empty without.
  std::function<bool(int, const Vec3&)> within(double kerf) const {
    if (!whole_) return {};
    return [this, kerf](int triangle, const Vec3& place) {
      const int element = mesh_.cells[at(surface_.triangle_cells[at(triangle)])].element;
      return whole_->holds(element, place, kBeside * kerf);
    };
  }

  void find_cells_of_whole() {
    for (const ShellCell& cell : mesh_.cells) whole_cells_.push_back(whole_->cell_of(mesh_, cell));
  }

  void collect_stretches() {
    for (Size c = 0; c < mesh_.cells.size(); ++c) {
      const ShellCell& cell = mesh_.cells[c];
      for (int s = 0; s < cell.corner_count; ++s) {
        const ShellCorner& from = corner(cell, s);
        if (from.side == SideKind::grain) facets_.push_back({-1, static_cast<int>(c), s, 0.0, 1.0, true});
        if (from.side != SideKind::element_edge) continue;
        const double p = edge_parameter(elements_, cell.element, from.side_id, from.barycentric);
        const double q =
            edge_parameter(elements_, cell.element, from.side_id, corner(cell, s + 1).barycentric);
        const int edge = elements_.topology.triangle_edges[at(cell.element)][at(from.side_id)];
        stretches_.push_back({edge, static_cast<int>(c), s, std::min(p, q), std::max(p, q), p < q});
      }
    }
    std::sort(stretches_.begin(), stretches_.end(), [](const SideStretch& a, const SideStretch& b) {
      return std::array{a.edge, a.cell, a.side} < std::array{b.edge, b.cell, b.side};
    });
    const auto id = [this](const SideStretch& s) {
      const ShellCell& cell = mesh_.cells[at(s.cell)];
      return std::array{cell.element, corner(cell, s.side).side_id, s.cell, s.side};
    };
    std::sort(facets_.begin(), facets_.end(),
              [&id](const SideStretch& a, const SideStretch& b) { return id(a) < id(b); });
  }

  /// Calls `action(i, j)` for every ordered pair of different stretches on one edge.
  template <class Action>
  void for_neighbours(const Action& action) const {
    for (Size first = 0; first < stretches_.size();) {
      Size last = first;
      while (last < stretches_.size() && stretches_[last].edge == stretches_[first].edge) ++last;
      for (Size i = first; i < last; ++i)
        for (Size j = first; j < last; ++j)
          if (i != j &&
              mesh_.cells[at(stretches_[i].cell)].element != mesh_.cells[at(stretches_[j].cell)].element)
            action(i, j);
      first = last;
    }
  }

  template <class Action>
  void for_facet_pairs(const Action& action) const {
    for (Size i = 0; i < facets_.size(); ++i) {
      const ShellCell& a = mesh_.cells[at(facets_[i].cell)];
      const int id = corner(a, facets_[i].side).side_id;
      for (Size j = i + 1; j < facets_.size(); ++j) {
        const ShellCell& b = mesh_.cells[at(facets_[j].cell)];
        if (b.element != a.element || corner(b, facets_[j].side).side_id != id) break;
        if (facets_[i].cell != facets_[j].cell) action(facets_[i], facets_[j]);
      }
    }
  }

  /// Parameter of a point along a polygon's side, 0 at its begin and 1 at its end.
  double along_side(const ShellCell& cell, int side, const Vec2& point) const {
    const Vec2 from = corner(cell, side).barycentric;
    const Vec2 along = corner(cell, side + 1).barycentric - from;
    const double squared = along.squaredNorm();
    return squared > 0.0 ? along.dot(point - from) / squared : 0.0;
  }

  void insert_neighbours_corners() {
    added_.resize(mesh_.cells.size());
    for_neighbours([this](Size i, Size j) {
      const SideStretch& a = stretches_[i];
      const SideStretch& b = stretches_[j];
      for (const double q : {b.begin, b.end})
        if (q > a.begin && q < a.end) {
          const ShellCell& cell = mesh_.cells[at(a.cell)];
          const int local_edge = corner(cell, a.side).side_id;
          const double key = a.is_forward ? q - a.begin : a.end - q;
          added_[at(a.cell)].push_back(
              {barycentric_on_edge(elements_, cell.element, local_edge, q), a.side, key});
        }
    });
    const auto insert = [this](const SideStretch& a, const SideStretch& b) {
      const ShellCell& cell = mesh_.cells[at(a.cell)];
      const ShellCell& other = mesh_.cells[at(b.cell)];
      for (int end = 0; end < 2; ++end) {
        const Vec2& point = corner(other, b.side + end).barycentric;
        const double t = along_side(cell, a.side, point);
        if (t > 1e-9 && t < 1.0 - 1e-9) added_[at(a.cell)].push_back({point, a.side, t});
      }
    };
    for_facet_pairs([&insert](const SideStretch& a, const SideStretch& b) {
      insert(a, b);
      insert(b, a);
    });
  }

  void number_nodes() {
    first_node_.push_back(0);
    for (Size c = 0; c < mesh_.cells.size(); ++c) {
      const ShellCell& cell = mesh_.cells[c];
      std::vector<BorderPoint>& added = added_[c];
      std::sort(added.begin(), added.end(), [](const BorderPoint& a, const BorderPoint& b) {
        return a.side != b.side ? a.side < b.side : a.key < b.key;
      });
      Size next = 0;
      for (int s = 0; s < cell.corner_count; ++s) {
        nodes_.push_back({corner(cell, s).barycentric, s, 0.0});
        for (; next < added.size() && added[next].side == s; ++next)
          if (added[next].barycentric != nodes_.back().barycentric) nodes_.push_back(added[next]);
      }
      first_node_.push_back(static_cast<int>(nodes_.size()));
    }
  }

  /// Nodes of one side, its end corner included.
  std::vector<int> side_nodes(int cell, int side) const {
    std::vector<int> found;
    const int begin = first_node_[at(cell)];
    const int end = first_node_[at(cell) + 1];
    for (int n = begin; n < end; ++n)
      if (nodes_[at(n)].side == side) found.push_back(n);
    const int after = found.back() + 1;
    found.push_back(after < end ? after : begin);
    return found;
  }

  void weld() {
    welds_ = std::make_unique<core::DisjointSets>(nodes_.size());
    touches_.assign(stretches_.size(), 0);
    for_neighbours([this](Size i, Size j) {
      if (i > j) return;
      const SideStretch& a = stretches_[i];
      const SideStretch& b = stretches_[j];
      const double from = std::max(a.begin, b.begin);
      const double to = std::min(a.end, b.end);
      if (to - from <= kTouch) return;
      touches_[i] = touches_[j] = 1;
      const auto parameter = [this](const SideStretch& s, int node) {
        const ShellCell& cell = mesh_.cells[at(s.cell)];
        return edge_parameter(elements_, cell.element, corner(cell, s.side).side_id,
                              nodes_[at(node)].barycentric);
      };
      const std::vector<int> nodes_b = side_nodes(b.cell, b.side);
      for (const int n : side_nodes(a.cell, a.side))
        for (const int m : nodes_b)
          if (parameter(a, n) == parameter(b, m)) welds_->unite(n, m);
    });
    for_facet_pairs([this](const SideStretch& a, const SideStretch& b) {
      const std::vector<int> nodes_b = side_nodes(b.cell, b.side);
      for (const int n : side_nodes(a.cell, a.side))
        for (const int m : nodes_b)
          if ((nodes_[at(n)].barycentric - nodes_[at(m)].barycentric).cwiseAbs().maxCoeff() < 1e-9)
            welds_->unite(n, m);
    });
  }

  void number_vertices() {
    vertex_of_node_.assign(nodes_.size(), -1);
    std::vector<int> number(nodes_.size(), -1);
    for (Size n = 0; n < nodes_.size(); ++n) {
      int& vertex = number[at(welds_->find(static_cast<int>(n)))];
      if (vertex < 0) vertex = vertex_count_++;
      vertex_of_node_[n] = vertex;
    }
  }

  /// The border of a cell in its element's plane.
  template <class PlaceOf>
  std::vector<Vec2> polygon_of(int c, const PlaceOf& place_of) const {
    const int element = mesh_.cells[at(c)].element;
    const Mat3 frame = facet_frame(elements_, element);
    const Vec3& origin = elements_.mesh.positions[at(elements_.mesh.triangles[at(element)][0])];
    std::vector<Vec2> flat;
    for (int n = first_node_[at(c)]; n < first_node_[at(c) + 1]; ++n) {
      const Vec3 p = place_of(n) - origin;
      flat.emplace_back(frame.col(0).dot(p), frame.col(1).dot(p));
    }
    return flat;
  }

  void triangulate_cell(int c) {
    const std::vector<Vec2> placed = polygon_of(c, [&](int n) { return place_of_node(c, n); });
    std::vector<Triangle> triangles = clip_ears(placed);
    // Beside slivers the whole may stand folded over; the material does not.
    if (whole_ && triangles.size() + 2 < placed.size()) {
      std::vector<Triangle> of_material =
          clip_ears(polygon_of(c, [&](int n) { return material_of_node(c, n); }));
      if (of_material.size() > triangles.size()) triangles = std::move(of_material);
    }
    const int begin = first_node_[at(c)];
    for (const Triangle& t : triangles) add_triangle(c, {begin + t[0], begin + t[1], begin + t[2]});
  }

  /// The polygon's side that the straight line between two nodes lies on, -1 for a line through the inside.
  int side_between(int c, int n, int m) const {
    const int begin = first_node_[at(c)];
    const int end = first_node_[at(c) + 1];
    const int next = n + 1 < end ? n + 1 : begin;
    return m == next ? nodes_[at(n)].side : -1;
  }

  void add_triangle(int c, const std::array<int, 3>& nodes) {
    const ShellCell& cell = mesh_.cells[at(c)];
    surface_.mesh.triangles.push_back(
        {vertex_of_node_[at(nodes[0])], vertex_of_node_[at(nodes[1])], vertex_of_node_[at(nodes[2])]});
    surface_.triangle_cells.push_back(c);
    surface_.triangle_grains.push_back(cell.grain);
    for (Size i = 0; i < 3; ++i) {
      const int side = side_between(c, nodes[i], nodes[(i + 1) % 3]);
      surface_.is_crack_side.push_back(side >= 0 && corner(cell, side).side == SideKind::crack);
    }
  }

  void place_vertices() {
    surface_.mesh.positions.assign(at(vertex_count_), Vec3::Zero());
    std::vector<char> is_placed(at(vertex_count_), 0);
    for (Size c = 0; c < mesh_.cells.size(); ++c)
      for (int n = first_node_[c]; n < first_node_[c + 1]; ++n) {
        const int v = vertex_of_node_[at(n)];
        if (is_placed[at(v)]) continue;
        is_placed[at(v)] = 1;
        Vec3& place = surface_.mesh.positions[at(v)];
        place = position_in_element(elements_, mesh_.cells[c].element, nodes_[at(n)].barycentric);
        if (whole_ && whole_cells_[c] >= 0) place = whole_->place(whole_cells_[c], place);
      }
  }

  /// Of a crack face: whether it was there in the whole already.
  BorderKind kind_of_face(int c, int side) const {
    if (!whole_ || whole_cells_[at(c)] < 0) return BorderKind::crack;
    const ShellCell& cell = mesh_.cells[at(c)];
    const Vec2 middle = 0.5 * (corner(cell, side).barycentric + corner(cell, side + 1).barycentric);
    return whole_->is_on_crack(whole_cells_[at(c)], corner(cell, side).side_id, middle)
               ? BorderKind::older_crack
               : BorderKind::crack;
  }

  Vec3 material_of_node(int c, int n) const {
    return position_in_element(elements_, mesh_.cells[at(c)].element, nodes_[at(n)].barycentric);
  }

  /// Before the kerf.
  Vec3 place_of_node(int c, int n) const {
    return whole_ ? surface_.mesh.positions[at(vertex_of_node_[at(n)])] : material_of_node(c, n);
  }

  /// Whether the whole stands back from its crack there: the lips of a slit meet at its ends, and some slits
  /// have nothing but ends.
  bool has_stood_back(int c, int n, const Vec3& inward, double kerf) const {
    return inward.dot(place_of_node(c, n) - material_of_node(c, n)) >= kStood * kerf;
  }

  void add_normals(int c, int side, BorderKind kind, double kerf, std::vector<BorderNormal>& normals) const {
    const ShellCell& cell = mesh_.cells[at(c)];
    const std::vector<int> ends = side_nodes(c, side);
    const Vec3 a = place_of_node(c, ends.front());
    const Vec3 b = place_of_node(c, ends.back());
    const Vec3 normal = facet_frame(elements_, cell.element).col(2);
    const double length = (b - a).norm();
    if (!(length > 0.0)) return;
    const Vec3 inward = normal.cross(b - a) / length;
    const int id = corner(cell, side).side_id;
    for (const int n : {ends.front(), ends.back()}) {
      const bool is_new = kind == BorderKind::older_crack && !has_stood_back(c, n, inward, kerf);
      normals.push_back(
          {vertex_of_node_[at(n)], inward, is_new ? BorderKind::crack : kind, cell.element, id});
    }
  }

  std::vector<Vec3> triangle_normals() const {
    std::vector<Vec3> normals;
    normals.reserve(surface_.triangle_cells.size());
    for (const int c : surface_.triangle_cells)
      normals.push_back(facet_frame(elements_, mesh_.cells[at(c)].element).col(2));
    return normals;
  }

  std::vector<BorderNormal> collect_normals(double kerf) const {
    std::vector<BorderNormal> normals;
    for (Size c = 0; c < mesh_.cells.size(); ++c)
      for (int s = 0; s < mesh_.cells[c].corner_count; ++s)
        if (corner(mesh_.cells[c], s).side == SideKind::crack)
          add_normals(static_cast<int>(c), s, kind_of_face(static_cast<int>(c), s), kerf, normals);
    for (Size i = 0; i < stretches_.size(); ++i)
      if (!touches_[i]) add_normals(stretches_[i].cell, stretches_[i].side, BorderKind::rim, kerf, normals);
    std::stable_sort(normals.begin(), normals.end(),
                     [](const BorderNormal& a, const BorderNormal& b) { return a.vertex < b.vertex; });
    return normals;
  }

  const ShellMesh& mesh_;
  const ShellElements& elements_;
  const StandingSurface* whole_;
  std::vector<int> whole_cells_;  // per cell, of the whole; empty without
  std::vector<SideStretch> stretches_;
  std::vector<SideStretch> facets_;
  std::vector<char> touches_;  // per stretch: material goes on there
  std::vector<std::vector<BorderPoint>> added_;
  std::vector<BorderPoint> nodes_;
  std::vector<int> first_node_;  // |cells| + 1
  std::unique_ptr<core::DisjointSets> welds_;
  std::vector<int> vertex_of_node_;
  int vertex_count_ = 0;
  ShellSurface surface_;
};

}  // namespace

ShellSurface extract_surface(const ShellMesh& mesh, double kerf, const StandingSurface* whole) {
  return SurfaceBuilder(mesh, whole).build(kerf);
}

MassProperties shell_mass_properties(const ShellMesh& mesh, double thickness, double density) {
  if (mesh.cells.empty()) return {};
  const auto point = [&mesh](const ShellCell& cell, int i) {
    return position_in_element(*mesh.elements, cell.element,
                               mesh.corners[at(cell.first_corner + i)].barycentric);
  };
  MassSum sum(point(mesh.cells.front(), 0));
  for (const ShellCell& cell : mesh.cells)
    for (int i = 1; i + 1 < cell.corner_count; ++i)
      sum.add_triangle(point(cell, 0), point(cell, i), point(cell, i + 1), density * thickness);
  return sum.properties();
}

}  // namespace shatterbox::geometry
