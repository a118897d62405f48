#include "engine/geometry/solid_surface.h"

#include <algorithm>
#include <array>
#include <memory>

#include "engine/core/disjoint_sets.h"
#include "engine/core/index.h"
#include "engine/geometry/ring_triangles.h"

namespace shatterbox::geometry {
namespace {

using Size = std::size_t;
using core::at;

/// Triangles of a facet as places in its list of sides, in the direction that the list runs in.
std::vector<Triangle> triangulate_facet(const SolidComplex& complex, const SolidFacet& facet) {
  if (facet.side_count < 3) return {};
  if (facet.side_count == 3) return {{0, 1, 2}};
  const Vec3 normal = facet_area_vector(complex, facet);
  int least = 0;
  normal.cwiseAbs().minCoeff(&least);
  const Vec3 u = normal.cross(Vec3::Unit(least)).normalized();
  const Vec3 w = normal.cross(u).normalized();
  const int* sides = complex.sides_of(facet);
  const Vec3& origin = complex.position(complex.side_begin(sides[0]));
  std::vector<Vec2> points;
  for (int i = 0; i < facet.side_count; ++i) {
    const Vec3 p = complex.position(complex.side_begin(sides[i])) - origin;
    points.emplace_back(u.dot(p), w.dot(p));
  }
  return triangulate_ring(points);
}

/// The border of a piece while it is put together.
class BorderBuilder {
 public:
  explicit BorderBuilder(const SolidComplex& complex) : complex_(complex) {}

  SolidSurface build() {
    collect_border();
    pair_over_edges();
    number_vertices();
    join_edges_of_digons();
    add_triangles();
    part_doubled_edges();
    return std::move(surface_);
  }

 private:
  /// A facet of the border: nothing on one of its sides.
  struct Border {
    int facet, first_corner;
    bool is_reversed;  // its outside is behind it
  };
  /// A side of a border facet, run with the material on its left seen from outside.
  struct BorderSide {
    int edge, border, place;
    bool is_forward;
  };
  /// A triangle's side that belongs to an edge of the surface, or to a diagonal (numbered on from these).
  struct Spoke {
    std::array<int, 2> ends;  // ascending
    int key, triangle;
  };

  void collect_border() {
    for (Size f = 0; f < complex_.facets.size(); ++f) {
      const SolidFacet& facet = complex_.facets[f];
      if (facet.parts[0] >= 0 || (facet.cells[0] < 0) == (facet.cells[1] < 0)) continue;
      borders_.push_back({static_cast<int>(f), corner_count_, facet.cells[0] < 0});
      corner_count_ += facet.side_count;
    }
  }

  /// Corners of two facets are one where the surface goes on from one to the other over an edge.
  void pair_over_edges() {
    welds_ = std::make_unique<core::DisjointSets>(at(corner_count_));
    pair_of_side_.assign(at(corner_count_), -1);
    std::vector<BorderSide> sides;
    sides.reserve(at(corner_count_));
    for (Size b = 0; b < borders_.size(); ++b) {
      const SolidFacet& facet = complex_.facets[at(borders_[b].facet)];
      for (int i = 0; i < facet.side_count; ++i) {
        const int side = complex_.sides_of(facet)[i];
        sides.push_back({side / 2, static_cast<int>(b), i, (side % 2 == 0) != borders_[b].is_reversed});
      }
    }
    std::vector<int> first(complex_.edges.size() + 1, 0);
    for (const BorderSide& side : sides) ++first[at(side.edge) + 1];
    for (Size e = 0; e < complex_.edges.size(); ++e) first[e + 1] += first[e];
    std::vector<BorderSide> sorted(sides.size());
    std::vector<int> next = first;
    for (const BorderSide& side : sides) sorted[at(next[at(side.edge)]++)] = side;
    for (Size e = 0; e < complex_.edges.size(); ++e) {
      const int count = first[e + 1] - first[e];
      if (count == 2) weld(sorted[at(first[e])], sorted[at(first[e]) + 1]);
      if (count > 2) pair_at_edge(sorted.data() + first[e], count);
    }
  }

  void weld(const BorderSide& a, const BorderSide& b) {
    const auto corners = [this](const BorderSide& s) {
      const Border& border = borders_[at(s.border)];
      const int count = complex_.facets[at(border.facet)].side_count;
      return std::array{border.first_corner + s.place, border.first_corner + (s.place + 1) % count};
    };
    const auto p = corners(a), q = corners(b);
    pair_of_side_[at(p[0])] = pair_of_side_[at(q[0])] = pair_count_++;
    const bool runs_same_way =
        complex_.sides_of(complex_.facets[at(borders_[at(a.border)].facet)])[a.place] ==
        complex_.sides_of(complex_.facets[at(borders_[at(b.border)].facet)])[b.place];
    welds_->unite(p[0], q[runs_same_way ? 0 : 1]);
    welds_->unite(p[1], q[runs_same_way ? 1 : 0]);
  }

  /// Several parts touch in an edge: each facet goes on to the one that is reached through material.
  void pair_at_edge(const BorderSide* sides, int count) {
    std::vector<char> is_paired(at(count), 0);
    for (int i = 0; i < count; ++i) {
      if (is_paired[at(i)]) continue;
      is_paired[at(i)] = 1;
      const int reached = facet_through_material(borders_[at(sides[i].border)].facet, sides[i].edge);
      int partner = -1;
      for (int j = i + 1; j < count; ++j) {
        if (is_paired[at(j)] || sides[j].is_forward == sides[i].is_forward) continue;
        const bool is_reached = borders_[at(sides[j].border)].facet == reached;
        if (partner < 0 || is_reached) partner = j;
        if (is_reached) break;
      }
      if (partner < 0) continue;
      is_paired[at(partner)] = 1;
      weld(sides[i], sides[partner]);
    }
  }

  /// The facet of the border that comes after `facet` about an edge, on the material's side; -1 if a cell on
  /// the way touches the edge with more than two facets.
  int facet_through_material(int facet, int edge) const {
    int cell = std::max(complex_.facets[at(facet)].cells[0], complex_.facets[at(facet)].cells[1]);
    for (int steps = 0; steps < 1000; ++steps) {
      int other = -1;
      const SolidPart& part = complex_.cells[at(cell)];
      for (int i = 0; i < part.facet_count; ++i) {
        const int f = complex_.cell_facets[at(part.first_facet + i)] / 2;
        const SolidFacet& candidate = complex_.facets[at(f)];
        const int* sides = complex_.sides_of(candidate);
        if (f == facet ||
            std::none_of(sides, sides + candidate.side_count, [edge](int side) { return side / 2 == edge; }))
          continue;
        if (other >= 0) return -1;
        other = f;
      }
      if (other < 0) return -1;
      const auto& cells = complex_.facets[at(other)].cells;
      if (cells[0] < 0 || cells[1] < 0) return other;
      cell = cells[0] == cell ? cells[1] : cells[0];
      facet = other;
    }
    return -1;
  }

  void number_vertices() {
    vertex_of_corner_.assign(at(corner_count_), -1);
    for (const Border& border : borders_) {
      const SolidFacet& facet = complex_.facets[at(border.facet)];
      for (int i = 0; i < facet.side_count; ++i) {
        const int corner = border.first_corner + i;
        const int root = welds_->find(corner);
        if (root == corner) {
          vertex_of_corner_[at(corner)] = static_cast<int>(surface_.mesh.positions.size());
          const int source = complex_.side_begin(complex_.sides_of(facet)[i]);
          surface_.mesh.positions.push_back(complex_.position(source));
          surface_.vertex_sources.push_back(source);
        } else {
          vertex_of_corner_[at(corner)] = vertex_of_corner_[at(root)];
        }
      }
    }
  }

  void add_triangle(const Triangle& triangle, int cell, const SolidFacet& facet) {
    surface_.mesh.triangles.push_back(triangle);
    surface_.triangle_cells.push_back(cell);
    surface_.triangle_grains.push_back(complex_.cells[at(cell)].grain);
    surface_.is_crack_face.push_back(facet.kind != FacetKind::outer);
    surface_.triangle_sources.push_back(facet.kind == FacetKind::outer ? facet.tag : -1);
  }

  /// A facet of two sides has no triangle: what it joins is joined in one edge.
  void join_edges_of_digons() {
    for (const Border& border : borders_) {
      if (complex_.facets[at(border.facet)].side_count != 2) continue;
      const int kept = pair_of_side_[at(border.first_corner)];
      const int gone = pair_of_side_[at(border.first_corner) + 1];
      std::replace(pair_of_side_.begin(), pair_of_side_.end(), gone, kept);
    }
  }

  void add_triangles() {
    int next_key = pair_count_;
    for (const Border& border : borders_) {
      const SolidFacet& facet = complex_.facets[at(border.facet)];
      std::vector<std::array<int, 3>> diagonals;  // place, place, key
      for (const Triangle& t : triangulate_facet(complex_, facet)) {
        Triangle triangle;
        for (Size k = 0; k < 3; ++k) triangle[k] = vertex_of_corner_[at(border.first_corner + t[k])];
        for (Size k = 0; k < 3; ++k) {
          const int a = t[k], b = t[(k + 1) % 3];
          int key = -1;
          if (b == (a + 1) % facet.side_count) key = pair_of_side_[at(border.first_corner + a)];
          for (const auto& d : diagonals)
            if (d[0] == b && d[1] == a) key = d[2];
          if (key < 0) {
            key = next_key++;
            diagonals.push_back({a, b, key});
          }
          const auto [low, high] = std::minmax(triangle[k], triangle[(k + 1) % 3]);
          spokes_.push_back({{low, high}, key, static_cast<int>(surface_.mesh.triangles.size())});
        }
        if (border.is_reversed) std::swap(triangle[1], triangle[2]);
        add_triangle(triangle, std::max(facet.cells[0], facet.cells[1]), facet);
      }
    }
  }

  /// Two edges of the surface between the same two vertices (parts that touch along them): all but the first
  /// get a vertex in their middle.
  void part_doubled_edges() {
    std::sort(spokes_.begin(), spokes_.end(), [](const Spoke& a, const Spoke& b) {
      return a.ends != b.ends ? a.ends < b.ends : a.key != b.key ? a.key < b.key : a.triangle < b.triangle;
    });
    for (Size first = 0; first < spokes_.size();) {
      Size last = first;
      while (last < spokes_.size() && spokes_[last].ends == spokes_[first].ends) ++last;
      for (Size i = first + 2; i + 1 < last; i += 2) {
        const auto ends = spokes_[i].ends;
        const int middle = static_cast<int>(surface_.mesh.positions.size());
        surface_.mesh.positions.push_back(
            0.5 * (surface_.mesh.positions[at(ends[0])] + surface_.mesh.positions[at(ends[1])]));
        surface_.vertex_sources.push_back(-1);
        for (const Size k : {i, i + 1}) split_triangle(spokes_[k].triangle, ends, middle);
      }
      first = last;
    }
  }

  /// Divides a triangle at a vertex on its side; of a triangle divided before, the part that has the side.
  void split_triangle(int number, const std::array<int, 2>& ends, int middle) {
    for (Size t = at(number);; t = at(divided_into(static_cast<int>(t)))) {
      Triangle& triangle = surface_.mesh.triangles[t];
      for (Size k = 0; k < 3; ++k) {
        const auto [low, high] = std::minmax(triangle[k], triangle[(k + 1) % 3]);
        if (low != ends[0] || high != ends[1]) continue;
        Triangle other = triangle;
        triangle[(k + 1) % 3] = middle;
        other[k] = middle;
        divided_.push_back({static_cast<int>(t), static_cast<int>(surface_.mesh.triangles.size())});
        surface_.mesh.triangles.push_back(other);
        surface_.triangle_cells.push_back(int(surface_.triangle_cells[t]));
        surface_.triangle_grains.push_back(int(surface_.triangle_grains[t]));
        surface_.triangle_sources.push_back(int(surface_.triangle_sources[t]));
        surface_.is_crack_face.push_back(std::uint8_t(surface_.is_crack_face[t]));
        return;
      }
      if (divided_into(static_cast<int>(t)) < 0) return;
    }
  }

  int divided_into(int triangle) const {
    for (auto d = divided_.rbegin(); d != divided_.rend(); ++d)
      if ((*d)[0] == triangle) return (*d)[1];
    return -1;
  }

  const SolidComplex& complex_;
  std::vector<Border> borders_;
  int corner_count_ = 0;
  std::unique_ptr<core::DisjointSets> welds_;
  std::vector<int> vertex_of_corner_;
  std::vector<int> pair_of_side_;  // by the side's first corner: number of its edge of the surface
  int pair_count_ = 0;
  std::vector<Spoke> spokes_;
  std::vector<std::array<int, 2>> divided_;  // triangle, its second part
  SolidSurface surface_;
};

}  // namespace

SolidSurface extract_surface(const SolidComplex& piece) {
  return BorderBuilder(piece).build();
}

MassProperties solid_mass_properties(const SolidComplex& piece, double density) {
  const auto for_border = [&piece](auto&& visit) {
    for (const SolidFacet& facet : piece.facets)
      if (facet.parts[0] < 0 && (facet.cells[0] < 0) != (facet.cells[1] < 0)) visit(facet);
  };
  Vec3 low = Vec3::Constant(1e300), high = Vec3::Constant(-1e300);
  for_border([&](const SolidFacet& facet) {
    for (int i = 0; i < facet.side_count; ++i) {
      const Vec3& p = piece.position(piece.side_begin(piece.sides_of(facet)[i]));
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
  });
  if (!(low.x() <= high.x())) return {};
  MassSum sum(0.5 * (low + high));
  for_border([&](const SolidFacet& facet) {
    const double sign = facet.cells[0] < 0 ? -density : density;
    const auto corner = [&](int i) { return piece.position(piece.side_begin(piece.sides_of(facet)[i])); };
    for (int i = 1; i + 1 < facet.side_count; ++i)
      sum.add_tetrahedron(corner(0), corner(i), corner(i + 1), sign);
  });
  return sum.properties();
}

}  // namespace shatterbox::geometry
