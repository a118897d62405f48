#include "engine/geometry/solid_cutter.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "engine/core/disjoint_sets.h"
#include "engine/core/index.h"
#include "engine/core/stop.h"
#include "engine/geometry/ring_triangles.h"

namespace shatterbox::geometry {
namespace {

using Size = std::size_t;
using core::at;

constexpr double kFlatLoop = 1e-9;  // of its squared length: the area of a loop that is no hole
constexpr double kPlane = 1e-12;    // of its size: a cap that deviates less is one facet

/// The point at `t` of the way from a to b, as a mean of their elements' nodes.
SolidVertex between(const SolidVertex& a, const SolidVertex& b, double t) {
  SolidVertex c;
  c.position = a.position + t * (b.position - a.position);
  c.kerf = a.kerf + t * (b.kerf - a.kerf);
  Size i = 0, j = 0, k = 0;
  while ((i < 4 && a.nodes[i] >= 0) || (j < 4 && b.nodes[j] >= 0)) {
    const bool has_a = i < 4 && a.nodes[i] >= 0;
    const bool has_b = j < 4 && b.nodes[j] >= 0;
    assert(k < 4);
    c.nodes[k] = !has_b || (has_a && a.nodes[i] < b.nodes[j]) ? a.nodes[i] : b.nodes[j];
    if (has_a && a.nodes[i] == c.nodes[k]) c.weights[k] += (1.0 - t) * a.weights[i++];
    if (has_b && b.nodes[j] == c.nodes[k]) c.weights[k] += t * b.weights[j++];
    ++k;
  }
  return c;
}

/// Two directions that make a right-handed frame with `axis`.
std::array<Vec3, 2> plane_of(const Vec3& axis) {
  int least = 0;
  axis.cwiseAbs().minCoeff(&least);
  const Vec3 u = axis.cross(Vec3::Unit(least)).normalized();
  return {u, axis.cross(u).normalized()};
}

}  // namespace

SolidCutter::SolidCutter(SolidComplex& complex, double snap)
    : complex_(complex),
      snap_(std::clamp(snap, kLeastSnap, 0.25)),
      first_cell_(complex.elements->mesh.tetrahedra.size(), -1),
      next_cell_(complex.cells.size(), -1),
      element_stamp_(complex.elements->mesh.tetrahedra.size(), 0),
      node_stamp_(complex.elements->mesh.positions.size(), 0),
      reach_(complex.elements->mesh.positions.size(), 0.0) {
  for (int c = static_cast<int>(complex.cells.size()) - 1; c >= 0; --c) {
    int& first = first_cell_[at(complex.cells[at(c)].element)];
    next_cell_[at(c)] = first;
    first = c;
  }
  grow();
}

void SolidCutter::grow() {
  vertex_marks_.resize(complex_.vertices.size());
  facet_marks_.resize(complex_.facets.size());
  cell_marks_.resize(complex_.cells.size());
  edge_marks_.resize(complex_.edges.size());
}

int SolidCutter::side_of(int cell) const {
  const Mark& mark = cell_marks_[at(cell)];
  return mark.stamp == stamp_ ? mark.sign : 0;
}

std::vector<int> SolidCutter::cells_of(int element) const {
  std::vector<int> cells;
  for (int c = first_cell_[at(element)]; c >= 0; c = next_cell_[at(c)]) cells.push_back(c);
  return cells;
}

void SolidCutter::cut(const SolidCut& cut) {
  ++stamp_;
  measure_reach(cut);
  touched_.clear();
  in_surface_.clear();
  for (const int c : cut.cells) {
    if (cell_marks_[at(c)].stamp == stamp_) continue;
    cell_marks_[at(c)] = {stamp_, 0, 0.0};
    settle_facet_list(complex_, c);
    const SolidPart& cell = complex_.cells[at(c)];
    for (int i = 0; i < cell.facet_count; ++i) {
      const int facet = complex_.cell_facets[at(cell.first_facet + i)] / 2;
      if (facet_marks_[at(facet)].stamp == stamp_) continue;
      facet_marks_[at(facet)].stamp = stamp_;
      settle_facet(complex_, facet);
      touched_.push_back(facet);
    }
  }
  // What lies on an edge of the border keeps to where the surface has that; so the border comes first.
  const auto is_border = [this](int facet) {
    const auto& cells = complex_.facets[at(facet)].cells;
    return cells[0] < 0 || cells[1] < 0;
  };
  for (const int facet : touched_)
    if (is_border(facet)) split_edges(facet, cut, true);
  for (const int facet : touched_)
    if (!is_border(facet)) split_edges(facet, cut, false);
  for (Size i = 0; i < touched_.size(); ++i) split_facet(touched_[i]);  // grows by their parts
  const int count = static_cast<int>(complex_.cells.size());
  for (const int c : cut.cells) {
    core::stop_if_asked();
    if (c < count && cell_marks_[at(c)].sign == 0) divide_cell(c, cut);
  }
  open_facets_in_surface(cut);
}

void SolidCutter::measure_reach(const SolidCut& cut) {
  const std::vector<Tetrahedron>& tetrahedra = complex_.elements->mesh.tetrahedra;
  for (const int c : cut.cells) {
    const int element = complex_.cells[at(c)].element;
    if (element_stamp_[at(element)] == stamp_) continue;
    element_stamp_[at(element)] = stamp_;
    const Tetrahedron& nodes = tetrahedra[at(element)];
    for (const int n : nodes)
      if (node_stamp_[at(n)] != stamp_) {
        node_stamp_[at(n)] = stamp_;
        reach_[at(n)] = 0.0;
      }
    for (const auto& edge : kTetrahedronEdges) {
      const int a = nodes[at(edge[0])];
      const int b = nodes[at(edge[1])];
      const double change = std::abs(cut.node_values[at(a)] - cut.node_values[at(b)]);
      reach_[at(a)] = std::max(reach_[at(a)], change);
      reach_[at(b)] = std::max(reach_[at(b)], change);
    }
  }
}

/// The bound for being on the surface is linear in each element, like the field: so the vertices on it lie in
/// a convex set, and a convex facet is never parted more than once.
int SolidCutter::sign_of(int v, const SolidCut& cut) {
  Mark& mark = vertex_marks_[at(v)];
  if (mark.stamp == stamp_) return mark.sign;
  const SolidVertex& vertex = complex_.vertices[at(v)];
  double value = 0.0, bound = 0.0;
  for (Size k = 0; k < 4 && vertex.nodes[k] >= 0; ++k) {
    value += vertex.weights[k] * cut.node_values[at(vertex.nodes[k])];
    bound += vertex.weights[k] * reach_[at(vertex.nodes[k])];
  }
  if (!cut.vertex_values.empty()) value = cut.vertex_values[at(v)];
  bound *= snap_;
  mark = {stamp_, value > bound ? 1 : value < -bound ? -1 : 0, value};
  return mark.sign;
}

void SolidCutter::split_edges(int number, const SolidCut& cut, bool is_border) {
  const SolidFacet facet = complex_.facets[at(number)];
  for (int i = 0; i < facet.side_count; ++i) {
    const int e = complex_.sides[at(facet.first_side + i)] / 2;
    const SolidEdge edge = complex_.edges[at(e)];
    if (edge.parts[0] >= 0 || sign_of(edge.ends[0], cut) * sign_of(edge.ends[1], cut) >= 0) continue;
    const double a = vertex_marks_[at(edge.ends[0])].value;
    const double b = vertex_marks_[at(edge.ends[1])].value;
    const int middle = static_cast<int>(complex_.vertices.size());
    const SolidVertex &from = complex_.vertices[at(edge.ends[0])], &to = complex_.vertices[at(edge.ends[1])];
    SolidVertex vertex = between(from, to, a / (a - b));
    vertex.has_kerf = is_border && from.has_kerf && to.has_kerf;
    complex_.vertices.push_back(vertex);
    vertex_marks_.push_back({stamp_, 0, 0.0});
    const int first = new_edge(edge.ends[0], middle);
    const int second = new_edge(middle, edge.ends[1]);
    complex_.edges[at(e)].parts = {first, second};
  }
}

int SolidCutter::new_edge(int from, int to) {
  complex_.edges.push_back({{from, to}, {-1, -1}});
  edge_marks_.emplace_back();
  return static_cast<int>(complex_.edges.size()) - 1;
}

/// Parts a facet along a chord between two of its corners on the surface, if it has corners on both sides.
void SolidCutter::split_facet(int number) {
  settle_facet(complex_, number);
  const SolidFacet facet = complex_.facets[at(number)];
  const int n = facet.side_count;
  const auto vertex = [&](int i) {
    return complex_.side_begin(complex_.sides[at(facet.first_side + i % n)]);
  };
  const auto sign = [&](int i) { return vertex_marks_[at(vertex(i))].sign; };
  // The corner on the surface, nearest to it, in the first change of sign from `from` to `to` after `start`.
  int first = 0;
  while (first < n && sign(first) == 0) ++first;
  if (first == n) return set_facet_sign(number);
  const auto find_change = [&](int start, int& last) {
    int best = -1;
    for (int i = start; i <= first + n; ++i) {
      if (sign(i) == 0) {
        if (best < 0 ||
            std::abs(vertex_marks_[at(vertex(i))].value) < std::abs(vertex_marks_[at(vertex(best))].value))
          best = i;
        continue;
      }
      if (sign(i) == -sign(start)) {
        last = i;
        return best;
      }
      best = -1;
    }
    return -1;
  };
  int second = 0, third = 0;
  const int begin = find_change(first, second);
  if (begin < 0) return set_facet_sign(number);
  const int end = find_change(second, third);
  assert(end > begin && end - begin < n);
  for (const int part : divide_facet(complex_, number, begin, end)) {
    facet_marks_.push_back({stamp_, 0, 0.0});
    touched_.push_back(part);
  }
  edge_marks_.emplace_back();
}

void SolidCutter::set_facet_sign(int number) {
  const SolidFacet& facet = complex_.facets[at(number)];
  for (int i = 0; i < facet.side_count; ++i) {
    const int sign = vertex_marks_[at(complex_.side_begin(complex_.sides_of(facet)[i]))].sign;
    if (sign == 0) continue;
    facet_marks_[at(number)].sign = sign;
    return;
  }
  facet_marks_[at(number)].sign = 0;
  in_surface_.push_back(number);
}

/// A facet that lies in the surface belongs to the side that the material behind it is on.
int SolidCutter::sign_of_facet_in_surface(int number, int facet_side) const {
  const SolidPart& cell = complex_.cells[at(number)];
  const SolidFacet& facet = complex_.facets[at(facet_side / 2)];
  const Vec3 normal = (facet_side % 2 == 0 ? 1.0 : -1.0) * facet_area_vector(complex_, facet);
  const Vec3& origin = complex_.position(complex_.side_begin(complex_.sides_of(facet)[0]));
  double clearest = 0.0;
  for (int i = 0; i < cell.facet_count; ++i) {
    const SolidFacet& other = complex_.facets[at(complex_.cell_facets[at(cell.first_facet + i)] / 2)];
    for (int k = 0; k < other.side_count; ++k) {
      const int v = complex_.side_begin(complex_.sides_of(other)[k]);
      const double slope = vertex_marks_[at(v)].value * normal.dot(complex_.position(v) - origin);
      if (std::abs(slope) > std::abs(clearest)) clearest = slope;
    }
  }
  return clearest > 0.0 ? -1 : 1;
}

/// The cell's facets and their signs; true if there are both signs.
bool SolidCutter::collect_facets(int number) {
  settle_facet_list(complex_, number);  // the facets themselves are settled by split_facet
  const SolidPart& cell = complex_.cells[at(number)];
  local_facets_.assign(complex_.cell_facets.begin() + cell.first_facet,
                       complex_.cell_facets.begin() + cell.first_facet + cell.facet_count);
  local_signs_.clear();
  bool has_plus = false, has_minus = false;
  for (const int facet : local_facets_) {
    const int sign = facet_marks_[at(facet / 2)].sign;
    local_signs_.push_back(sign);
    has_plus = has_plus || sign > 0;
    has_minus = has_minus || sign < 0;
  }
  for (Size i = 0; i < local_facets_.size(); ++i)
    if (local_signs_[i] == 0)
      local_signs_[i] =
          has_plus != has_minus ? (has_plus ? 1 : -1) : sign_of_facet_in_surface(number, local_facets_[i]);
  cell_marks_[at(number)].sign = has_plus || !has_minus ? 1 : -1;
  return has_plus && has_minus;
}

/// Where facets of both signs meet, as closed loops, each through a vertex only once: the borders of the caps
/// of the positive side.
void SolidCutter::collect_loops() {
  ++cell_stamp_;
  scratch_.clear();
  for (Size i = 0; i < local_facets_.size(); ++i) {
    const SolidFacet& facet = complex_.facets[at(local_facets_[i] / 2)];
    for (int k = 0; k < facet.side_count; ++k) {
      const int side = complex_.sides_of(facet)[k];
      EdgeMark& mark = edge_marks_[at(side / 2)];
      if (mark.stamp != cell_stamp_) {
        mark = {cell_stamp_, 0, -1, -1};
        scratch_.push_back(side / 2);
      }
      int& first = local_signs_[i] > 0 ? mark.plus : mark.minus;
      if (first < 0) first = static_cast<int>(i);
      if (local_signs_[i] > 0) mark.net += (side + local_facets_[i]) % 2 == 0 ? 1 : -1;
    }
  }
  loop_sides_.clear();
  for (const int e : scratch_)
    for (int k = 0; k < std::abs(edge_marks_[at(e)].net); ++k)
      loop_sides_.push_back(2 * e + (edge_marks_[at(e)].net > 0 ? 1 : 0));
  loops_.clear();
  const Size kept = loop_sides_.size();
  std::vector<char> is_used(kept, 0);
  std::vector<int> path;
  for (Size start = 0; start < kept; ++start) {
    if (is_used[start]) continue;
    is_used[start] = 1;
    path.assign(1, loop_sides_[start]);
    while (!path.empty()) {
      const int end = complex_.side_end(path.back());
      Size first = 0;
      while (first < path.size() && complex_.side_begin(path[first]) != end) ++first;
      if (first < path.size()) {
        loops_.emplace_back();
        loops_.back().sides.assign(path.begin() + static_cast<std::ptrdiff_t>(first), path.end());
        path.resize(first);
        continue;
      }
      Size next = 0;
      while (next < kept && (is_used[next] || complex_.side_begin(loop_sides_[next]) != end)) ++next;
      assert(next < kept);
      is_used[next] = 1;
      path.push_back(loop_sides_[next]);
    }
  }
}

/// Sets the caps' axis (positive to negative side) and says which loops are the holes of which.
void SolidCutter::group_loops() {
  axis_.setZero();
  for (const CapLoop& loop : loops_) {
    const Vec3& origin = complex_.position(complex_.side_begin(loop.sides[0]));
    for (const int side : loop.sides)
      axis_ += (complex_.position(complex_.side_begin(side)) - origin)
                   .cross(complex_.position(complex_.side_end(side)) - origin);
  }
  const double size = axis_.norm();
  axis_ = size > 0.0 ? Vec3(axis_ / size) : Vec3::UnitX();
  const auto [u, w] = plane_of(axis_);
  const Vec3 origin = complex_.position(complex_.side_begin(loops_[0].sides[0]));
  for (CapLoop& loop : loops_) {
    loop.points.clear();
    for (const int side : loop.sides) {
      const Vec3 p = complex_.position(complex_.side_begin(side)) - origin;
      loop.points.emplace_back(u.dot(p), w.dot(p));
    }
  }
  group_count_ = 0;
  std::vector<double> areas;
  for (CapLoop& loop : loops_) {
    areas.push_back(twice_area(loop.points));
    double length = 0.0;
    for (Size i = 0; i < loop.points.size(); ++i)
      length += (loop.points[(i + 1) % loop.points.size()] - loop.points[i]).norm();
    // What is hardly wider than a line is no hole.
    if (areas.back() > -kFlatLoop * length * length) loop.group = group_count_++;
  }
  for (Size h = 0; h < loops_.size(); ++h) {
    if (loops_[h].group >= 0) continue;
    int best = -1;
    for (Size l = 0; l < loops_.size(); ++l)
      if (loops_[l].group >= 0 && areas[l] > -areas[h] && is_inside(loops_[l].points, loops_[h].points[0]) &&
          (best < 0 || areas[l] < areas[at(best)]))
        best = static_cast<int>(l);
    loops_[h].group = best >= 0 ? loops_[at(best)].group : group_count_++;
  }
}

int SolidCutter::add_facet(const std::vector<int>& sides, const SolidCut& cut) {
  SolidFacet facet;
  facet.first_side = static_cast<int>(complex_.sides.size());
  facet.side_count = static_cast<int>(sides.size());
  facet.kind = cut.kind;
  facet.tag = cut.id;
  facet.plane = cut.plane;
  complex_.sides.insert(complex_.sides.end(), sides.begin(), sides.end());
  complex_.facets.push_back(facet);
  facet_marks_.push_back({stamp_, 0, 0.0});
  return static_cast<int>(complex_.facets.size()) - 1;
}

/// A hole that shares a corner with the loop about it becomes a part of it.
void SolidCutter::splice_touching_loops(std::vector<CapLoop*>& loops) const {
  for (Size h = 1; h < loops.size();) {
    CapLoop& outer = *loops[0];
    CapLoop& hole = *loops[h];
    bool is_spliced = false;
    for (Size i = 0; i < outer.sides.size() && !is_spliced; ++i)
      for (Size k = 0; k < hole.sides.size() && !is_spliced; ++k) {
        if (complex_.side_begin(outer.sides[i]) != complex_.side_begin(hole.sides[k])) continue;
        const auto from = static_cast<std::ptrdiff_t>(k), to = static_cast<std::ptrdiff_t>(i);
        std::rotate(hole.sides.begin(), hole.sides.begin() + from, hole.sides.end());
        std::rotate(hole.points.begin(), hole.points.begin() + from, hole.points.end());
        outer.sides.insert(outer.sides.begin() + to, hole.sides.begin(), hole.sides.end());
        outer.points.insert(outer.points.begin() + to, hole.points.begin(), hole.points.end());
        is_spliced = true;
      }
    if (is_spliced)
      loops.erase(loops.begin() + static_cast<std::ptrdiff_t>(h)), h = 1;
    else
      ++h;
  }
}

/// The facets that close one border (a loop, and then its holes): one where it is plane and convex, or else
/// triangles.
void SolidCutter::cap(std::vector<CapLoop*> loops, const SolidCut& cut, std::vector<int>& caps) {
  splice_touching_loops(loops);
  const std::vector<int>& sides = loops[0]->sides;
  const std::vector<Vec2>& points = loops[0]->points;
  if (loops.size() == 1 && sides.size() > 3) {
    const Vec3& origin = complex_.position(complex_.side_begin(sides[0]));
    double size = 0.0, deviation = 0.0, least_turn = 0.0;
    for (Size i = 0; i < sides.size(); ++i) {
      const Vec3 p = complex_.position(complex_.side_begin(sides[i])) - origin;
      size = std::max(size, p.squaredNorm());
      deviation = std::max(deviation, std::abs(axis_.dot(p)));
      least_turn =
          std::min(least_turn,
                   twice_area({points[i], points[(i + 1) % points.size()], points[(i + 2) % points.size()]}));
    }
    if (deviation <= kPlane * std::sqrt(size) && least_turn >= -kPlane * size) {
      caps.push_back(add_facet(sides, cut));
      return;
    }
  }
  if (loops.size() == 1 && sides.size() <= 3) {
    caps.push_back(add_facet(sides, cut));
    return;
  }
  std::vector<std::vector<Vec2>> borders;
  for (const CapLoop* loop : loops) borders.push_back(loop->points);
  const std::vector<std::array<int, 2>> ring = join_holes(borders);
  const int n = static_cast<int>(ring.size());
  std::vector<Vec2> ring_points;
  std::vector<int> ring_sides;
  std::vector<std::array<int, 3>> diagonals;  // place, place, edge
  for (int i = 0; i < n; ++i) {
    const auto [loop, place] = ring[at(i)];
    ring_points.push_back(loops[at(loop)]->points[at(place)]);
    const auto next = ring[at((i + 1) % n)];
    const std::vector<int>& own = loops[at(loop)]->sides;
    const bool is_side = next[0] == loop && next[1] == (place + 1) % static_cast<int>(own.size());
    ring_sides.push_back(is_side ? own[at(place)] : -1);
  }
  for (int i = 0; i < n; ++i) {
    if (ring_sides[at(i)] >= 0)
      continue;  // a bridge: its way back is where the same corners follow each other
    const auto from = ring[at(i)];
    const auto to = ring[at((i + 1) % n)];
    int back = i + 1;
    while (ring_sides[at(back)] >= 0 || ring[at(back)] != to || ring[at((back + 1) % n)] != from) ++back;
    const int bridge = new_edge(complex_.side_begin(loops[at(from[0])]->sides[at(from[1])]),
                                complex_.side_begin(loops[at(to[0])]->sides[at(to[1])]));
    ring_sides[at(i)] = 2 * bridge;
    ring_sides[at(back)] = 2 * bridge + 1;
  }
  const auto vertex = [&](int i) { return complex_.side_begin(ring_sides[at(i)]); };
  const auto side_between = [&](int i, int j) {
    if (j == (i + 1) % n) return ring_sides[at(i)];
    for (const auto& d : diagonals)
      if (d[0] == j && d[1] == i) return 2 * d[2] + 1;
    diagonals.push_back({i, j, new_edge(vertex(i), vertex(j))});
    return 2 * diagonals.back()[2];
  };
  for (const Triangle& t : triangulate_ring(ring_points))
    caps.push_back(
        add_facet({side_between(t[0], t[1]), side_between(t[1], t[2]), side_between(t[2], t[0])}, cut));
}

void SolidCutter::divide_cell(int number, const SolidCut& cut) {
  if (!collect_facets(number)) return;
  collect_loops();
  if (loops_.empty()) return;  // shells that nothing connects, each on one side
  group_loops();
  assign_parts(number, cut);
}

/// A closed border that encloses less than nothing is a cavity of the part about it: the smallest one of its
/// side whose box holds a vertex of it.
void SolidCutter::join_cavities(core::DisjointSets& parts, const std::vector<std::vector<int>>& caps) const {
  struct Shell {
    int root = 0, sign = 0;
    double volume = 0.0;
    Vec3 low = Vec3::Zero(), high = Vec3::Zero(), vertex = Vec3::Zero();
  };
  const int facet_count = static_cast<int>(local_facets_.size());
  std::vector<Shell> shells;
  for (int root = 0; root < facet_count; ++root)
    if (parts.find(root) == root) {
      shells.emplace_back();
      shells.back().root = root;
      shells.back().sign = local_signs_[at(root)];
    }
  if (shells.size() < 3) return;
  for (Shell& shell : shells) {
    const SolidFacet& first = complex_.facets[at(local_facets_[at(shell.root)] / 2)];
    shell.low = shell.high = shell.vertex =
        complex_.position(complex_.side_begin(complex_.sides_of(first)[0]));
    const auto add = [&](int facet_side) {
      const SolidFacet& facet = complex_.facets[at(facet_side / 2)];
      const int* sides = complex_.sides_of(facet);
      const Vec3 arm = complex_.position(complex_.side_begin(sides[0])) - shell.vertex;
      shell.volume += (facet_side % 2 == 0 ? 1.0 : -1.0) / 3.0 * facet_area_vector(complex_, facet).dot(arm);
      for (int k = 0; k < facet.side_count; ++k) {
        shell.low = shell.low.cwiseMin(complex_.position(complex_.side_begin(sides[k])));
        shell.high = shell.high.cwiseMax(complex_.position(complex_.side_begin(sides[k])));
      }
    };
    for (int i = shell.root; i < facet_count; ++i)
      if (parts.find(i) == shell.root) add(local_facets_[at(i)]);
    for (int g = 0; g < group_count_; ++g)
      for (int side = 0; side < 2; ++side)
        if (parts.find(facet_count + 2 * g + side) == shell.root)
          for (const int facet : caps[at(g)]) add(2 * facet + side);
  }
  for (const Shell& cavity : shells) {
    if (cavity.volume >= 0.0) continue;
    const Shell* best = nullptr;
    for (const Shell& shell : shells)
      if (shell.sign == cavity.sign && shell.volume > 0.0 && (cavity.vertex - shell.low).minCoeff() >= 0.0 &&
          (shell.high - cavity.vertex).minCoeff() >= 0.0 && (!best || shell.volume < best->volume))
        best = &shell;
    if (best) parts.unite(best->root, cavity.root);
  }
}

/// Caps the parts of the cell and gives each its number.
void SolidCutter::assign_parts(int number, const SolidCut& cut) {
  const int facet_count = static_cast<int>(local_facets_.size());
  core::DisjointSets parts(at(facet_count + 2 * group_count_));
  for (int i = 0; i < facet_count; ++i) {
    const SolidFacet& facet = complex_.facets[at(local_facets_[at(i)] / 2)];
    for (int k = 0; k < facet.side_count; ++k) {
      const EdgeMark& mark = edge_marks_[at(complex_.sides_of(facet)[k] / 2)];
      parts.unite(i, local_signs_[at(i)] > 0 ? mark.plus : mark.minus);
    }
  }
  std::vector<std::vector<int>> caps(at(group_count_));
  for (int g = 0; g < group_count_; ++g) {
    std::vector<CapLoop*> loops;
    for (CapLoop& loop : loops_)
      if (loop.group == g) {
        loops.push_back(&loop);
        for (const int side : loop.sides) {
          parts.unite(facet_count + 2 * g, edge_marks_[at(side / 2)].plus);
          parts.unite(facet_count + 2 * g + 1, edge_marks_[at(side / 2)].minus);
        }
      }
    // The loop about the others comes first.
    std::stable_sort(loops.begin(), loops.end(), [](const CapLoop* a, const CapLoop* b) {
      return twice_area(a->points) > twice_area(b->points);
    });
    cap(loops, cut, caps[at(g)]);
  }
  join_cavities(parts, caps);
  const SolidPart whole = complex_.cells[at(number)];
  for (int root = 0; root < facet_count; ++root) {
    if (parts.find(root) != root) continue;
    int cell = number;
    if (root > 0) {
      cell = static_cast<int>(complex_.cells.size());
      complex_.cells.push_back(whole);
      cell_marks_.emplace_back();
      next_cell_.push_back(-1);
      int last = first_cell_[at(whole.element)];
      while (next_cell_[at(last)] >= 0) last = next_cell_[at(last)];
      next_cell_[at(last)] = cell;
    }
    cell_marks_[at(cell)] = {stamp_, local_signs_[at(root)], 0.0};
    const int first = static_cast<int>(complex_.cell_facets.size());
    for (int i = root; i < facet_count; ++i) {
      if (parts.find(i) != root) continue;
      const int facet = local_facets_[at(i)];
      complex_.cell_facets.push_back(facet);
      complex_.facets[at(facet / 2)].cells[at(facet % 2)] = cell;
    }
    for (int g = 0; g < group_count_; ++g)
      for (int side = 0; side < 2; ++side) {
        if (parts.find(facet_count + 2 * g + side) != root) continue;
        for (const int facet : caps[at(g)]) {
          complex_.cell_facets.push_back(2 * facet + side);
          complex_.facets[at(facet)].cells[at(side)] = cell;
        }
      }
    SolidPart& part = complex_.cells[at(cell)];
    part.first_facet = first;
    part.facet_count = static_cast<int>(complex_.cell_facets.size()) - first;
    part.is_measured = false;
  }
}

void SolidCutter::open_facets_in_surface(const SolidCut& cut) {
  for (const int number : in_surface_) {
    SolidFacet& facet = complex_.facets[at(number)];
    if (facet.cells[0] < 0 || facet.cells[1] < 0 || facet.kind == FacetKind::crack) continue;
    if (facet.kind == FacetKind::grain && cut.kind == FacetKind::grain) continue;
    if (side_of(facet.cells[0]) * side_of(facet.cells[1]) >= 0) continue;
    facet.kind = cut.kind;
    facet.tag = cut.id;
    facet.plane = cut.plane;
  }
}

void keep_off_nodes(const SolidComplex& complex, double share, SolidCut& cut) {
  std::vector<double> reach(cut.node_values.size(), 0.0);
  for (const int c : cut.cells) {
    const Tetrahedron& nodes = complex.elements->mesh.tetrahedra[at(complex.cells[at(c)].element)];
    for (const auto& edge : kTetrahedronEdges) {
      const int a = nodes[at(edge[0])];
      const int b = nodes[at(edge[1])];
      const double change = std::abs(cut.node_values[at(a)] - cut.node_values[at(b)]);
      reach[at(a)] = std::max(reach[at(a)], change);
      reach[at(b)] = std::max(reach[at(b)], change);
    }
  }
  for (Size n = 0; n < reach.size(); ++n) {
    double& value = cut.node_values[n];
    const double least = share * reach[n];
    if (least > 0.0 && std::abs(value) < least) value = value < 0.0 ? -least : least;
  }
}

}  // namespace shatterbox::geometry
