#include "engine/geometry/surface_crossings.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "engine/core/index.h"
#include "engine/geometry/bvh.h"
#include "engine/geometry/mesh_findings.h"
#include "engine/geometry/orientation.h"

namespace shatterbox::geometry {
namespace {

using Size = std::size_t;
using core::at;
using Corners = std::array<Vec3, 3>;

/// Sorts (owner, value) pairs by owner, keeping their order within one, into a list of lists.
template <class Value>
void gather(const std::vector<std::pair<int, Value>>& pairs, Size owners, std::vector<int>& first,
            std::vector<Value>& values) {
  first.assign(owners + 1, 0);
  for (const auto& [owner, value] : pairs) ++first[at(owner) + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<int> next(first.begin(), first.end() - 1);
  values.resize(pairs.size());
  for (const auto& [owner, value] : pairs) values[at(next[at(owner)]++)] = value;
}

class CrossingSearch {
 public:
  CrossingSearch(const SolidElements& elements, const TriangleMesh& surface, const EdgeTopology& edges)
      : mesh_(elements.mesh),
        topology_(elements.topology),
        surface_(surface),
        surface_edges_(edges),
        tree_(build_triangle_tree(surface.positions, surface.triangles)),
        boxes_(node_boxes(tree_, surface)),
        triangle_boxes_(triangle_boxes(surface)) {}

  core::Result<SurfaceCrossings> run() {
    found_.vertex_tetrahedron.assign(surface_.positions.size(), -1);
    found_.has_material.assign(mesh_.tetrahedra.size(), 0);
    is_edge_done_.assign(topology_.edges.size(), 0);
    is_face_done_.assign(topology_.faces.size(), 0);
    for (Size t = 0; t < mesh_.tetrahedra.size(); ++t) search_tetrahedron(t);
    gather(edge_pairs_, topology_.edges.size(), found_.first_edge_crossing, found_.edge_crossings);
    gather(face_pairs_, topology_.faces.size(), found_.first_face_crossing, found_.face_crossings);
    order_along_edges();
    if (const auto fault = find_inside()) return core::Error{*fault};
    mark_material();
    return std::move(found_);
  }

 private:
  const Vec3& vertex(int v) const { return mesh_.positions[at(v)]; }
  const Vec3& surface_vertex(int v) const { return surface_.positions[at(v)]; }
  Corners triangle(int t) const {
    const Triangle& corners = surface_.triangles[at(t)];
    return {surface_vertex(corners[0]), surface_vertex(corners[1]), surface_vertex(corners[2])};
  }
  Corners face(int f) const {
    const auto& corners = topology_.faces[at(f)];
    return {vertex(corners[0]), vertex(corners[1]), vertex(corners[2])};
  }

  /// Triangles whose boxes touch `box`, in an order that the tree gives.
  void find_near(const Box& box) {
    near_.clear();
    stack_.assign(1, 0);
    while (!stack_.empty()) {
      const int n = stack_.back();
      stack_.pop_back();
      if (!overlaps(boxes_[at(n)], box)) continue;
      const TriangleTree::Node& node = tree_.nodes[at(n)];
      for (int i = node.begin; i < node.begin + node.count; ++i)
        if (overlaps(triangle_boxes_[at(tree_.order[at(i)])], box)) near_.push_back(tree_.order[at(i)]);
      if (node.count > 0) continue;
      stack_.push_back(node.right);
      stack_.push_back(n + 1);
    }
  }

  void search_tetrahedron(Size t) {
    Box box;
    for (const int v : mesh_.tetrahedra[t]) box.include(vertex(v));
    find_near(box);
    if (near_.empty()) return;
    for (const int e : topology_.tetrahedron_edges[t])
      if (!is_edge_done_[at(e)]) search_edge(e);
    for (const int f : topology_.tetrahedron_faces[t])
      if (!is_face_done_[at(f)]) search_face(f);
    for (const int n : near_)
      for (const int v : surface_.triangles[at(n)])
        if (found_.vertex_tetrahedron[at(v)] < 0 && contains(t, surface_vertex(v)))
          found_.vertex_tetrahedron[at(v)] = static_cast<int>(t);
  }

  void search_edge(int e) {
    is_edge_done_[at(e)] = 1;
    const Vec3& a = vertex(topology_.edges[at(e)][0]);
    const Vec3& b = vertex(topology_.edges[at(e)][1]);
    Box box;
    box.include(a);
    box.include(b);
    for (const int n : near_) {
      if (!overlaps(triangle_boxes_[at(n)], box)) continue;
      const int passage = passage_of_edge(a, b, triangle(n));
      if (passage != 0) edge_pairs_.push_back({e, {n, passage < 0}});
    }
  }

  void search_face(int f) {
    is_face_done_[at(f)] = 1;
    const Corners corners = face(f);
    Box box;
    for (const Vec3& corner : corners) box.include(corner);
    for (const int n : near_) {
      if (!overlaps(triangle_boxes_[at(n)], box)) continue;
      for (const int edge : surface_edges_.triangle_edges[at(n)]) {
        // Once an edge: by the first of its triangles.
        if (surface_edges_.edge_triangles[at(surface_edges_.first_triangle[at(edge)])] != n) continue;
        const auto& [p, q] = surface_edges_.edges[at(edge)];
        const int passage = passage_of_surface_edge(surface_vertex(p), surface_vertex(q), corners);
        if (passage != 0) face_pairs_.push_back({f, {edge, passage}});
      }
    }
  }

  bool contains(Size t, const Vec3& p) const {
    for (int f = 0; f < 4; ++f)
      if (side_of_face(face(topology_.tetrahedron_faces[t][at(f)]), p) !=
          -face_direction(mesh_.tetrahedra[t], f))
        return false;
    return true;
  }

  void order_along_edges() {
    for (Size e = 0; e < topology_.edges.size(); ++e) {
      const auto begin = found_.edge_crossings.begin() + found_.first_edge_crossing[e];
      const auto end = found_.edge_crossings.begin() + found_.first_edge_crossing[e + 1];
      if (end - begin < 2) continue;
      const Vec3& a = vertex(topology_.edges[e][0]);
      const Vec3& b = vertex(topology_.edges[e][1]);
      std::sort(begin, end,
                [](const EdgeCrossing& p, const EdgeCrossing& q) { return p.triangle < q.triangle; });
      // Few, and a comparison may be dear: by insertion, which keeps equals in the order of their numbers.
      for (auto i = begin + 1; i != end; ++i)
        for (auto k = i;
             k != begin && is_passed_before(a, b, triangle(k->triangle), triangle((k - 1)->triangle)); --k)
          std::iter_swap(k, k - 1);
    }
  }

  /// In or out: followed along the edges of the mesh, from one vertex of each connected part.
  std::optional<std::string> find_inside() {
    constexpr std::uint8_t kUnknown = 2;
    found_.is_inside.assign(mesh_.positions.size(), kUnknown);
    std::vector<int> first, neighbours;
    std::vector<std::pair<int, int>> pairs;
    for (Size e = 0; e < topology_.edges.size(); ++e)
      for (const int v : topology_.edges[e]) pairs.push_back({v, static_cast<int>(e)});
    gather(pairs, mesh_.positions.size(), first, neighbours);
    std::vector<int> reached;
    for (Size seed = 0; seed < mesh_.positions.size(); ++seed) {
      if (found_.is_inside[seed] != kUnknown) continue;
      found_.is_inside[seed] = is_point_inside(mesh_.positions[seed]) ? 1 : 0;
      reached.assign(1, static_cast<int>(seed));
      for (Size i = 0; i < reached.size(); ++i)
        for (int k = first[at(reached[i])]; k < first[at(reached[i]) + 1]; ++k) {
          const Size e = at(neighbours[at(k)]);
          const auto& [a, b] = topology_.edges[e];
          const int count = found_.first_edge_crossing[e + 1] - found_.first_edge_crossing[e];
          const int other = a == reached[i] ? b : a;
          if (found_.is_inside[at(other)] != kUnknown) continue;
          found_.is_inside[at(other)] =
              found_.is_inside[at(reached[i])] ^ static_cast<std::uint8_t>(count & 1);
          reached.push_back(other);
        }
    }
    return find_wrong_turn();
  }

  /// The mesh's vertex, by the triangles on the way to a place beyond the surface.
  bool is_point_inside(const Vec3& p) {
    if (surface_.triangles.empty()) return false;
    const Vec3 size = boxes_[0].high - boxes_[0].low;
    // Beyond in a direction that no surface is likely to know; any would do.
    const Vec3 far = boxes_[0].high + Vec3(0.31, 0.47, 0.17) * (1.0 + 1e-3) * size.maxCoeff();
    Box box;
    box.include(p);
    box.include(far);
    find_near(box);
    int count = 0;
    for (const int n : near_)
      if (passage_of_edge(p, far, triangle(n)) != 0) ++count;
    return count % 2 == 1;
  }

  std::optional<std::string> find_wrong_turn() const {
    for (Size e = 0; e < topology_.edges.size(); ++e) {
      bool is_inside = found_.is_inside[at(topology_.edges[e][0])] != 0;
      for (int k = found_.first_edge_crossing[e]; k < found_.first_edge_crossing[e + 1]; ++k) {
        const EdgeCrossing& crossing = found_.edge_crossings[at(k)];
        if (crossing.enters == is_inside) {
          const Corners t = triangle(crossing.triangle);
          return "The surface crosses itself, is open or badly wound near triangle " +
                 std::to_string(crossing.triangle + 1) + " at " + at_place((t[0] + t[1] + t[2]) / 3.0) +
                 ": what is inside there cannot be told. Mend it there.";
        }
        is_inside = crossing.enters;
      }
    }
    return std::nullopt;
  }

  void mark_material() {
    for (Size t = 0; t < mesh_.tetrahedra.size(); ++t) {
      bool has = false;
      for (const int v : mesh_.tetrahedra[t]) has |= found_.is_inside[at(v)] != 0;
      for (const int e : topology_.tetrahedron_edges[t])
        has |= found_.first_edge_crossing[at(e)] < found_.first_edge_crossing[at(e) + 1];
      for (const int f : topology_.tetrahedron_faces[t])
        has |= found_.first_face_crossing[at(f)] < found_.first_face_crossing[at(f) + 1];
      found_.has_material[t] = has ? 1 : 0;
    }
    for (const int t : found_.vertex_tetrahedron)
      if (t >= 0) found_.has_material[at(t)] = 1;
  }

  const TetMesh& mesh_;
  const TetTopology& topology_;
  const TriangleMesh& surface_;
  const EdgeTopology& surface_edges_;
  TriangleTree tree_;
  std::vector<Box> boxes_, triangle_boxes_;
  std::vector<int> near_, stack_;
  std::vector<std::uint8_t> is_edge_done_, is_face_done_;
  std::vector<std::pair<int, EdgeCrossing>> edge_pairs_;
  std::vector<std::pair<int, FaceCrossing>> face_pairs_;
  SurfaceCrossings found_;
};

}  // namespace

core::Result<SurfaceCrossings> find_surface_crossings(const SolidElements& elements,
                                                      const TriangleMesh& surface,
                                                      const EdgeTopology& surface_edges) {
  return CrossingSearch(elements, surface, surface_edges).run();
}

}  // namespace shatterbox::geometry
