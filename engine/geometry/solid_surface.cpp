#include "engine/geometry/solid_surface.h"

#include <algorithm>
#include <array>
#include <memory>
#include <utility>

#include "engine/core/disjoint_sets.h"
#include "engine/core/index.h"
#include "engine/geometry/ring_triangles.h"

namespace shatterbox::geometry {
namespace {

using Size = std::size_t;
using core::at;

constexpr double kStraight = 1e-11;  // sine: an edge that turns by less at a vertex is straight

/// By numbers in [0, number_count); those of one number stay in their order.
template <class Item, class Number>
std::vector<Item> sorted_by(std::vector<Item> items, Size number_count, const Number& number_of) {
  std::vector<Size> next(number_count + 1, 0);
  for (const Item& item : items) ++next[at(number_of(item)) + 1];
  for (Size n = 0; n < number_count; ++n) next[n + 1] += next[n];
  std::vector<Item> sorted(items.size());
  for (Item& item : items) sorted[next[at(number_of(item))]++] = std::move(item);
  return sorted;
}

/// The border of a piece while it is put together.
class BorderBuilder {
 public:
  explicit BorderBuilder(const SolidComplex& complex) : complex_(complex) {}

  SolidSurface build() {
    collect_border();
    pair_over_edges();
    number_vertices();
    collect_regions();
    mark_needless_vertices();
    chain_loops();
    add_triangles();
    part_doubled_edges();
    part_doubled_vertices();
    drop_needless_vertices();
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
  /// A closed part of a region's rim, counter-clockwise about the region.
  struct Loop {
    int region = 0;
    std::vector<int> vertices,
        keys;  // keys: numbers of the surface's edges, each from its vertex to the next
  };
  /// A triangle's side that belongs to an edge of the surface, or to a diagonal (numbered on from these).
  struct Spoke {
    std::array<int, 2> ends;  // ascending
    int key, triangle;
  };

  void collect_border() {
    for (const int f : find_border_facets(complex_)) {
      const SolidFacet& facet = complex_.facets[at(f)];
      borders_.push_back({f, corner_count_, facet.cells[0] < 0});
      corner_count_ += facet.side_count;
    }
  }

  /// Corners of two facets are one where the surface goes on from one to the other over an edge.
  void pair_over_edges() {
    welds_ = std::make_unique<core::DisjointSets>(at(corner_count_));
    partner_.assign(at(corner_count_), -1);
    std::vector<BorderSide> sides;
    sides.reserve(at(corner_count_));
    for (Size b = 0; b < borders_.size(); ++b) {
      const SolidFacet& facet = complex_.facets[at(borders_[b].facet)];
      for (int i = 0; i < facet.side_count; ++i) {
        const int side = complex_.sides_of(facet)[i];
        sides.push_back({side / 2, static_cast<int>(b), i, (side % 2 == 0) != borders_[b].is_reversed});
      }
    }
    sides = sorted_by(std::move(sides), complex_.edges.size(), [](const BorderSide& s) { return s.edge; });
    for (Size first = 0; first < sides.size();) {
      Size last = first + 1;
      while (last < sides.size() && sides[last].edge == sides[first].edge) ++last;
      const int count = static_cast<int>(last - first);
      if (count == 2) weld(sides[first], sides[first + 1]);
      if (count > 2) pair_at_edge(sides.data() + first, count);
      first = last;
    }
  }

  void weld(const BorderSide& a, const BorderSide& b) {
    const auto corners = [this](const BorderSide& s) {
      const Border& border = borders_[at(s.border)];
      const int count = complex_.facets[at(border.facet)].side_count;
      return std::array{border.first_corner + s.place, border.first_corner + (s.place + 1) % count};
    };
    const auto p = corners(a), q = corners(b);
    partner_[at(p[0])] = q[0];
    partner_[at(q[0])] = p[0];
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
          const SolidVertex& vertex = complex_.vertices[at(source)];
          surface_.mesh.positions.push_back(vertex.position + vertex.kerf);
          surface_.vertex_sources.push_back(source);
          surface_.has_kerf.push_back(vertex.has_kerf);
        } else {
          vertex_of_corner_[at(corner)] = vertex_of_corner_[at(root)];
        }
      }
    }
  }

  // Sides of border facets are numbered like the corners they begin in, and run with the material on their
  // left seen from outside.
  const Border& border_of(int side) const { return borders_[at(border_of_corner_[at(side)])]; }
  int next_corner(int corner, int step) const {
    const Border& border = border_of(corner);
    const int count = complex_.facets[at(border.facet)].side_count;
    return border.first_corner + (corner - border.first_corner + step + count) % count;
  }
  int begin_of(int side) const {
    return vertex_of_corner_[at(border_of(side).is_reversed ? next_corner(side, 1) : side)];
  }
  int end_of(int side) const {
    return vertex_of_corner_[at(border_of(side).is_reversed ? side : next_corner(side, 1))];
  }
  int next_side(int side) const { return next_corner(side, border_of(side).is_reversed ? -1 : 1); }

  /// Whether the surface has two neighbours as one: parts of one given triangle, or of one plane wall.
  static bool are_of_one_region(const SolidFacet& a, const SolidFacet& b) {
    if (a.kind != b.kind || a.tag != b.tag || a.tag < 0) return false;
    if (a.kind == FacetKind::outer) return true;
    return a.plane >= 0 && a.plane == b.plane && (a.cells[0] < 0) == (b.cells[0] < 0);
  }

  /// A region is a facet, or all connected ones of one given triangle or plane wall.
  void collect_regions() {
    border_of_corner_.resize(at(corner_count_));
    for (Size b = 0; b < borders_.size(); ++b)
      for (int i = 0; i < complex_.facets[at(borders_[b].facet)].side_count; ++i)
        border_of_corner_[at(borders_[b].first_corner + i)] = static_cast<int>(b);
    core::DisjointSets together(borders_.size());
    for (int side = 0; side < corner_count_; ++side) {
      if (partner_[at(side)] < side) continue;
      const SolidFacet& a = complex_.facets[at(border_of(side).facet)];
      const SolidFacet& b = complex_.facets[at(border_of(partner_[at(side)]).facet)];
      if (are_of_one_region(a, b))
        together.unite(border_of_corner_[at(side)], border_of_corner_[at(partner_[at(side)])]);
    }
    region_of_border_.resize(borders_.size());
    for (Size b = 0; b < borders_.size(); ++b) region_of_border_[b] = together.find(static_cast<int>(b));
  }

  int region_of(int side) const { return region_of_border_[at(border_of_corner_[at(side)])]; }
  bool is_rim(int side) const {
    return partner_[at(side)] < 0 || region_of(partner_[at(side)]) != region_of(side);
  }

  /// The surface does without vertices inside regions, and on a straight edge between two.
  void mark_needless_vertices() {
    const Size count = surface_.mesh.positions.size();
    std::vector<int> rims(count, 0);
    std::vector<std::array<int, 2>> neighbours(count, {-1, -1});
    for (int side = 0; side < corner_count_; ++side)
      if (is_rim(side)) {
        const int v = begin_of(side);
        if (rims[at(v)] < 2) neighbours[at(v)][at(rims[at(v)])] = end_of(side);
        ++rims[at(v)];
      }
    is_needless_.assign(count, 0);
    for (Size v = 0; v < count; ++v) {
      is_needless_[v] = rims[v] == 0;
      if (rims[v] != 2 || neighbours[v][0] == neighbours[v][1]) continue;
      const Vec3 a = surface_.mesh.positions[v] - surface_.mesh.positions[at(neighbours[v][0])];
      const Vec3 b = surface_.mesh.positions[at(neighbours[v][1])] - surface_.mesh.positions[v];
      is_needless_[v] = a.dot(b) > 0.0 &&
                        a.cross(b).squaredNorm() <= kStraight * kStraight * a.squaredNorm() * b.squaredNorm();
    }
  }

  /// The rims of all regions as loops of vertices that are needed.
  void chain_loops() {
    std::vector<char> is_used(at(corner_count_), 0);
    std::vector<int> sides;
    for (int start = 0; start < corner_count_; ++start) {
      if (is_used[at(start)] || !is_rim(start)) continue;
      sides.clear();
      for (int side = start; !is_used[at(side)];) {
        is_used[at(side)] = 1;
        sides.push_back(side);
        side = next_side(side);
        while (!is_rim(side)) side = next_side(partner_[at(side)]);
      }
      loops_.push_back(make_loop(sides));
    }
    loops_ = sorted_by(std::move(loops_), borders_.size(), [](const Loop& loop) { return loop.region; });
  }

  Loop make_loop(const std::vector<int>& sides) {
    Loop loop;
    loop.region = region_of(sides[0]);
    const int n = static_cast<int>(sides.size());
    loop.vertices.reserve(sides.size());
    loop.keys.reserve(sides.size());
    int first = 0;
    while (first < n && is_needless_[at(begin_of(sides[at(first)]))]) ++first;
    for (int i = 0; i < n; ++i) {
      const int side = sides[at((first + i) % n)];
      const int key = std::min(side, std::max(partner_[at(side)], 0));
      if (loop.vertices.empty() || !is_needless_[at(begin_of(side))]) {
        loop.vertices.push_back(begin_of(side));
        loop.keys.push_back(key);
      } else {
        loop.keys.back() = std::min(loop.keys.back(), key);  // the same from both of the edge's regions
        surface_.on_edges.push_back({begin_of(side), loop.vertices.back(), -1, 0.0});
      }
      const int end = end_of(side);
      if (!is_needless_[at(end)])
        for (auto on = surface_.on_edges.rbegin(); on != surface_.on_edges.rend() && on->to < 0; ++on)
          place(*on, end);
    }
    return loop;
  }

  /// Says where on its edge, which ends at `to`, a vertex is.
  void place(SolidSurface::OnEdge& on, int to) const {
    const std::vector<Vec3>& positions = surface_.mesh.positions;
    const Vec3 way = positions[at(to)] - positions[at(on.from)];
    on.to = to;
    on.share = way.dot(positions[at(on.source)] - positions[at(on.from)]) / way.squaredNorm();
  }

  void add_triangle(const Triangle& triangle, const Border& border) {
    const SolidFacet& facet = complex_.facets[at(border.facet)];
    const int cell = std::max(facet.cells[0], facet.cells[1]);
    surface_.mesh.triangles.push_back(triangle);
    surface_.triangle_cells.push_back(cell);
    surface_.triangle_facets.push_back(border.facet);
    surface_.triangle_grains.push_back(complex_.cells[at(cell)].grain);
    surface_.is_crack_face.push_back(facet.kind != FacetKind::outer);
    surface_.is_old_face.push_back(facet.kind == FacetKind::old_crack);
    surface_.triangle_sources.push_back(facet.kind == FacetKind::outer ? facet.tag : -1);
  }

  void add_triangles() {
    std::vector<Vec3> normals(borders_.size(), Vec3::Zero());  // of regions
    for (Size b = 0; b < borders_.size(); ++b)
      normals[at(region_of_border_[b])] +=
          (borders_[b].is_reversed ? -1.0 : 1.0) *
          facet_area_vector(complex_, complex_.facets[at(borders_[b].facet)]);
    next_key_ = corner_count_;
    for (Size first = 0; first < loops_.size();) {
      Size last = first + 1;
      while (last < loops_.size() && loops_[last].region == loops_[first].region) ++last;
      triangulate_region(first, last, normals[at(loops_[first].region)]);
      first = last;
    }
  }

  /// The triangles of one region: of the loop about it with its holes, if there is one such; of each loop
  /// otherwise, which closes it all the same.
  void triangulate_region(Size first, Size last, const Vec3& normal) {
    int least = 0;
    normal.cwiseAbs().minCoeff(&least);
    const Vec3 u = normal.cross(Vec3::Unit(least)).normalized();
    const Vec3 w = normal.cross(u).normalized();
    const Vec3& origin = surface_.mesh.positions[at(loops_[first].vertices[0])];
    std::vector<std::vector<Vec2>> points;
    std::vector<Size> outer;
    for (Size l = first; l < last; ++l) {
      points.emplace_back();
      for (const int v : loops_[l].vertices) {
        const Vec3 p = surface_.mesh.positions[at(v)] - origin;
        points.back().emplace_back(u.dot(p), w.dot(p));
      }
      if (twice_area(points.back()) > 0.0) outer.push_back(l);
    }
    if (outer.size() == 1) {
      std::swap(points[0], points[outer[0] - first]);
      std::swap(loops_[first], loops_[outer[0]]);
      triangulate_loops(first, join_holes(points), points);
      return;
    }
    for (Size l = first; l < last; ++l)
      triangulate_loops(l, join_holes({points[l - first]}), {points[l - first]});
  }

  /// True of a triangle that has a corner twice, where a loop comes to a vertex again: it is left out, and
  /// its two other sides are one.
  bool join_over_doubled(const Triangle& triangle, const std::array<int, 3>& keys) {
    for (Size k = 0; k < 3; ++k) {
      if (triangle[k] != triangle[(k + 1) % 3]) continue;
      joined_keys_.push_back({keys[(k + 1) % 3], keys[(k + 2) % 3]});
      doubled_.push_back(triangle[k]);
      return true;
    }
    return false;
  }

  void triangulate_loops(Size first, const std::vector<std::array<int, 2>>& ring,
                         const std::vector<std::vector<Vec2>>& points) {
    if (ring.size() == 2)  // what has no width has no triangle: its two edges are one
      joined_keys_.push_back({loops_[first].keys[0], loops_[first].keys[1]});
    if (ring.size() < 3) return;
    std::vector<Vec2> ring_points;
    for (const auto& [loop, place] : ring) ring_points.push_back(points[at(loop)][at(place)]);
    std::vector<std::array<int, 5>> diagonals;  // loop, place, loop, place, key
    const auto key_between = [&](const std::array<int, 2>& a, const std::array<int, 2>& b) {
      const Loop& loop = loops_[first + at(a[0])];
      if (a[0] == b[0] && b[1] == (a[1] + 1) % static_cast<int>(loop.vertices.size()))
        return loop.keys[at(a[1])];
      for (const auto& d : diagonals)
        if (d[0] == b[0] && d[1] == b[1] && d[2] == a[0] && d[3] == a[1]) return d[4];
      diagonals.push_back({a[0], a[1], b[0], b[1], next_key_++});
      return diagonals.back()[4];
    };
    for (const Triangle& t : triangulate_ring(ring_points)) {
      Triangle triangle;
      for (Size k = 0; k < 3; ++k) {
        const auto& a = ring[at(t[k])];
        triangle[k] = loops_[first + at(a[0])].vertices[at(a[1])];
      }
      std::array<int, 3> keys;  // of its sides
      for (Size k = 0; k < 3; ++k) keys[k] = key_between(ring[at(t[k])], ring[at(t[(k + 1) % 3])]);
      if (join_over_doubled(triangle, keys)) continue;
      for (Size k = 0; k < 3; ++k) {
        const auto [low, high] = std::minmax(triangle[k], triangle[(k + 1) % 3]);
        spokes_.push_back({{low, high}, keys[k], static_cast<int>(surface_.mesh.triangles.size())});
      }
      add_triangle(triangle, borders_[at(loops_[first].region)]);
    }
  }

  void drop_needless_vertices() {
    for (SolidSurface::OnEdge& on : surface_.on_edges) on.source = surface_.vertex_sources[at(on.source)];
    std::vector<int> number(surface_.mesh.positions.size(), -1);
    for (const Triangle& t : surface_.mesh.triangles)
      for (const int v : t) number[at(v)] = 0;
    int count = 0;
    for (Size v = 0; v < number.size(); ++v) {
      if (number[v] < 0) continue;
      surface_.mesh.positions[at(count)] = Vec3(surface_.mesh.positions[v]);
      surface_.vertex_sources[at(count)] = surface_.vertex_sources[v];
      surface_.has_kerf[at(count)] = surface_.has_kerf[v];
      number[v] = count++;
    }
    surface_.mesh.positions.resize(at(count));
    surface_.vertex_sources.resize(at(count));
    surface_.has_kerf.resize(at(count));
    std::erase_if(surface_.on_edges, [&](const SolidSurface::OnEdge& on) {
      return on.to < 0 || number[at(on.from)] < 0 || number[at(on.to)] < 0;
    });
    for (SolidSurface::OnEdge& on : surface_.on_edges) {
      on.from = number[at(on.from)];
      on.to = number[at(on.to)];
    }
    for (Triangle& t : surface_.mesh.triangles)
      for (int& v : t) v = number[at(v)];
  }

  /// Two edges of the surface between the same two vertices (parts that touch along them): all but the first
  /// get a vertex in their middle.
  void part_doubled_edges() {
    for (Size j = 0; j < joined_keys_.size(); ++j) {
      const auto [kept, gone] = joined_keys_[j];
      for (Spoke& spoke : spokes_)
        if (spoke.key == gone) spoke.key = kept;
      for (Size k = j + 1; k < joined_keys_.size(); ++k)
        std::replace(joined_keys_[k].begin(), joined_keys_[k].end(), gone, kept);
    }
    // Those of one vertex are few.
    spokes_ = sorted_by(std::move(spokes_), surface_.mesh.positions.size(),
                        [](const Spoke& spoke) { return spoke.ends[0]; });
    for (auto first = spokes_.begin(); first != spokes_.end();) {
      const int begin = first->ends[0];
      const auto last =
          std::find_if(first, spokes_.end(), [begin](const Spoke& spoke) { return spoke.ends[0] != begin; });
      std::sort(first, last, [](const Spoke& a, const Spoke& b) {
        return a.ends != b.ends ? a.ends < b.ends : a.key != b.key ? a.key < b.key : a.triangle < b.triangle;
      });
      first = last;
    }
    for (Size first = 0; first < spokes_.size();) {
      Size last = first;
      while (last < spokes_.size() && spokes_[last].ends == spokes_[first].ends) ++last;
      for (Size i = first + 2; i + 1 < last; i += 2) {
        const auto ends = spokes_[i].ends;
        const int middle = static_cast<int>(surface_.mesh.positions.size());
        surface_.mesh.positions.push_back(
            0.5 * (surface_.mesh.positions[at(ends[0])] + surface_.mesh.positions[at(ends[1])]));
        surface_.vertex_sources.push_back(-1);
        surface_.has_kerf.push_back(
            std::uint8_t(surface_.has_kerf[at(ends[0])] & surface_.has_kerf[at(ends[1])]));
        for (const Size k : {i, i + 1}) split_triangle(spokes_[k].triangle, ends, middle);
      }
      first = last;
    }
  }

  /// Each fan of triangles about a vertex to which a loop came again gets one of its own.
  void part_doubled_vertices() {
    std::sort(doubled_.begin(), doubled_.end());
    doubled_.erase(std::unique(doubled_.begin(), doubled_.end()), doubled_.end());
    for (const int vertex : doubled_) {
      std::vector<Size> around;  // triangles
      for (Size t = 0; t < surface_.mesh.triangles.size(); ++t)
        if (std::count(surface_.mesh.triangles[t].begin(), surface_.mesh.triangles[t].end(), vertex) > 0)
          around.push_back(t);
      bool is_first = true;
      while (!around.empty()) {
        const std::vector<Size> fan = take_fan(vertex, around);
        if (!std::exchange(is_first, false)) give_copy(vertex, fan);
      }
    }
  }

  /// Takes from the triangles around a vertex those that hang together by edges with the first.
  std::vector<Size> take_fan(int vertex, std::vector<Size>& around) const {
    const auto shares_edge = [&](Size t, Size other) {
      const Triangle &a = surface_.mesh.triangles[t], &b = surface_.mesh.triangles[other];
      return std::any_of(a.begin(), a.end(),
                         [&](int v) { return v != vertex && std::find(b.begin(), b.end(), v) != b.end(); });
    };
    std::vector<Size> fan{around.front()};
    around.erase(around.begin());
    for (Size k = 0; k < fan.size(); ++k) {
      const auto rest = std::stable_partition(around.begin(), around.end(),
                                              [&](Size t) { return !shares_edge(fan[k], t); });
      fan.insert(fan.end(), rest, around.end());
      around.erase(rest, around.end());
    }
    return fan;
  }

  void give_copy(int vertex, const std::vector<Size>& fan) {
    const int copy = static_cast<int>(surface_.mesh.positions.size());
    surface_.mesh.positions.push_back(Vec3(surface_.mesh.positions[at(vertex)]));
    surface_.vertex_sources.push_back(int(surface_.vertex_sources[at(vertex)]));
    surface_.has_kerf.push_back(std::uint8_t(surface_.has_kerf[at(vertex)]));
    for (const Size t : fan) {
      Triangle& triangle = surface_.mesh.triangles[t];
      for (SolidSurface::OnEdge& on : surface_.on_edges) {
        const int other = on.from == vertex ? on.to : on.to == vertex ? on.from : -1;
        if (other < 0 || std::find(triangle.begin(), triangle.end(), other) == triangle.end()) continue;
        (on.from == vertex ? on.from : on.to) = copy;
      }
      std::replace(triangle.begin(), triangle.end(), vertex, copy);
    }
  }

  /// Divides a triangle at a vertex on its side; of a triangle divided before, the part that has the side.
  void split_triangle(int number, const std::array<int, 2>& ends, int middle) {
    std::vector<int> parts{number};
    for (const auto& [whole, part] : divided_)
      if (std::find(parts.begin(), parts.end(), whole) != parts.end()) parts.push_back(part);
    for (const int t : parts) {
      Triangle& triangle = surface_.mesh.triangles[at(t)];
      for (Size k = 0; k < 3; ++k) {
        const auto [low, high] = std::minmax(triangle[k], triangle[(k + 1) % 3]);
        if (low != ends[0] || high != ends[1]) continue;
        Triangle other = triangle;
        triangle[(k + 1) % 3] = middle;
        other[k] = middle;
        divided_.push_back({t, static_cast<int>(surface_.mesh.triangles.size())});
        add_part(other, at(t));
        return;
      }
    }
  }

  /// A triangle that is of the same facet as another.
  void add_part(const Triangle& triangle, Size of) {
    surface_.mesh.triangles.push_back(triangle);
    surface_.triangle_cells.push_back(int(surface_.triangle_cells[of]));
    surface_.triangle_grains.push_back(int(surface_.triangle_grains[of]));
    surface_.triangle_sources.push_back(int(surface_.triangle_sources[of]));
    surface_.triangle_facets.push_back(int(surface_.triangle_facets[of]));
    surface_.is_crack_face.push_back(std::uint8_t(surface_.is_crack_face[of]));
    surface_.is_old_face.push_back(std::uint8_t(surface_.is_old_face[of]));
  }

  const SolidComplex& complex_;
  std::vector<Border> borders_;
  int corner_count_ = 0;
  std::unique_ptr<core::DisjointSets> welds_;
  std::vector<int> vertex_of_corner_;
  std::vector<int> partner_;  // of each side: that of the facet the surface goes on to
  std::vector<int> border_of_corner_, region_of_border_;
  std::vector<char> is_needless_;  // per vertex
  std::vector<Loop> loops_;
  int next_key_ = 0;
  std::vector<std::array<int, 2>> joined_keys_;
  std::vector<int> doubled_;  // vertices to which loops came again
  std::vector<Spoke> spokes_;
  std::vector<std::array<int, 2>> divided_;  // triangle, its second part
  SolidSurface surface_;
};

}  // namespace

SolidSurface extract_surface(const SolidComplex& piece) {
  return BorderBuilder(piece).build();
}

MassProperties solid_mass_properties(const SolidComplex& piece, double density) {
  const std::vector<int> border = find_border_facets(piece);
  const auto for_border = [&](auto&& visit) {
    for (const int f : border) visit(piece.facets[at(f)]);
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
