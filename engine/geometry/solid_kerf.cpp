#include "engine/geometry/solid_kerf.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "engine/core/index.h"
#include "engine/core/stop.h"
#include "engine/geometry/bvh.h"
#include "engine/geometry/crossings.h"
#include "engine/geometry/solid_parting.h"
#include "engine/geometry/solid_retreat.h"

namespace shatterbox::geometry {
namespace {

using Size = std::size_t;
using core::at;

constexpr double kShareOfWidth = 0.25;  // of the material's width: the most that a vertex retreats
constexpr double kFarthest = 8.0;       // kerfs: from where a piece's vertex would be to its whole's surface
constexpr double kFlatWall = 1e-6;      // of its extent: by which corners of a wall may be off its plane
constexpr int kHalvings = 24;           // rounds in which a kerf that is still too wide is halved

/// Triangles, with boxes about them for one state of their vertices. The positions must outlive it.
struct BoxedMesh {
  const std::vector<Vec3>& positions;
  std::vector<Triangle> triangles;
  TriangleTree tree;
  std::vector<Box> boxes;

  BoxedMesh(const std::vector<Vec3>& p, std::vector<Triangle> t)
      : positions(p), triangles(std::move(t)), tree(build_triangle_tree(positions, triangles)) {
    update();
  }
  /// The same triangles elsewhere: boxes differ, and the tree is as good.
  BoxedMesh(const std::vector<Vec3>& p, const BoxedMesh& other)
      : positions(p), triangles(other.triangles), tree(other.tree) {
    update();
  }
  Box box_of(const Triangle& t) const {
    const Vec3 &p = positions[at(t[0])], &q = positions[at(t[1])], &r = positions[at(t[2])];
    return {p.cwiseMin(q).cwiseMin(r), p.cwiseMax(q).cwiseMax(r)};
  }
  void update() {
    const auto vertex_box = [this](int vertex) {
      Box box;
      box.include(positions[at(vertex)]);
      return box;
    };
    refit(tree, triangles, vertex_box, boxes);
  }
};

bool an_edge_passes(const BoxedMesh& edges, const Triangle& e, const BoxedMesh& mesh, const Triangle& t) {
  for (Size i = 0; i < 3; ++i)
    if (segment_pierces_triangle(edges.positions[at(e[i])], edges.positions[at(e[(i + 1) % 3])],
                                 mesh.positions[at(t[0])], mesh.positions[at(t[1])],
                                 mesh.positions[at(t[2])]))
      return true;
  return false;
}

/// Calls visit(number of a, number of b) for the triangles of `a` and `b` of which one passes through the
/// other; not for those that `are_exempt`.
template <class Exempt, class Visit>
void for_crossing(const BoxedMesh& a, const BoxedMesh& b, const Exempt& are_exempt, const Visit& visit) {
  std::vector<std::pair<int, int>> stack;
  for_each_leaf_pair(a.tree, a.boxes, b.tree, b.boxes, 0.0, stack,
                     [&](const TriangleTree::Node& leaf_a, const TriangleTree::Node& leaf_b) {
                       for (int i = leaf_a.begin; i < leaf_a.begin + leaf_a.count; ++i)
                         for (int k = leaf_b.begin; k < leaf_b.begin + leaf_b.count; ++k) {
                           const int ta = a.tree.order[at(i)], tb = b.tree.order[at(k)];
                           const Triangle &first = a.triangles[at(ta)], &second = b.triangles[at(tb)];
                           if (are_exempt(ta, tb) || !overlaps(a.box_of(first), b.box_of(second))) continue;
                           if (an_edge_passes(a, first, b, second) || an_edge_passes(b, second, a, first))
                             visit(ta, tb);
                         }
                     });
}

/// Where a way from a vertex first meets a face that is not at the vertex, its border included, in lengths of
/// the way; `most` if nowhere before that.
double way_to_face(const BoxedMesh& mesh, int vertex, const Vec3& way, double most) {
  constexpr double kParallel = 1e-9, kOnSide = 1e-6;
  const Vec3& start = mesh.positions[at(vertex)];
  Box box;
  box.include(start);
  box.include(start + most * way);
  double nearest = most;
  std::vector<int> stack{0};
  while (!stack.empty()) {
    const int number = stack.back();
    stack.pop_back();
    if (!overlaps(mesh.boxes[at(number)], box)) continue;
    const TriangleTree::Node& node = mesh.tree.nodes[at(number)];
    if (node.count == 0) {
      stack.push_back(node.right);
      stack.push_back(number + 1);
    }
    for (int k = node.begin; k < node.begin + node.count; ++k) {
      const Triangle& t = mesh.triangles[at(mesh.tree.order[at(k)])];
      if (std::find(t.begin(), t.end(), vertex) != t.end()) continue;
      const Vec3& a = mesh.positions[at(t[0])];
      const Vec3 ab = mesh.positions[at(t[1])] - a, ac = mesh.positions[at(t[2])] - a;
      const Vec3 normal = ab.cross(ac);
      const double steepness = normal.dot(way), squared = normal.squaredNorm();
      if (!(steepness * steepness > kParallel * kParallel * squared * way.squaredNorm())) continue;
      const double length = normal.dot(a - start) / steepness;
      if (!(length > kParallel && length < nearest)) continue;
      const Vec3 hit = start + length * way - a;
      const double b = normal.dot(hit.cross(ac)) / squared, c = normal.dot(ab.cross(hit)) / squared;
      if (b >= -kOnSide && c >= -kOnSide && b + c <= 1.0 + kOnSide) nearest = length;
    }
  }
  return nearest;
}

/// Those with a vertex that is marked.
std::vector<int> triangles_at(const TriangleMesh& mesh, const std::vector<char>& is_marked) {
  std::vector<int> found;
  for (Size t = 0; t < mesh.triangles.size(); ++t)
    if (std::any_of(mesh.triangles[t].begin(), mesh.triangles[t].end(),
                    [&](int v) { return is_marked[at(v)] != 0; }))
      found.push_back(static_cast<int>(t));
  return found;
}

/// A box that holds all that a vertex on its way back, or a face that it takes along, can meet.
Box reach_of(const TriangleMesh& mesh, const std::vector<Vec3>& shift) {
  double longest = 0.0;
  std::vector<char> is_moved(shift.size(), 0);
  for (Size v = 0; v < shift.size(); ++v) {
    is_moved[v] = shift[v].isZero(0.0) ? 0 : 1;
    longest = std::max(longest, shift[v].norm());
  }
  Box box;
  for (const int t : triangles_at(mesh, is_moved))
    for (const int v : mesh.triangles[at(t)]) box.include(mesh.positions[at(v)]);
  const Vec3 way = Vec3::Constant(2.0 / kShareOfWidth * longest);
  return {box.low - way, box.high + way};
}

std::vector<int> triangles_in(const TriangleMesh& mesh, const Box& box) {
  std::vector<int> found;
  for (Size t = 0; t < mesh.triangles.size(); ++t) {
    Box own;
    for (const int v : mesh.triangles[t]) own.include(mesh.positions[at(v)]);
    if (overlaps(own, box)) found.push_back(static_cast<int>(t));
  }
  return found;
}

/// Shortens shifts to a quarter of the material's width in their direction; then halves what leads a moved
/// face through a crack face or another moved one. What cannot be helped so stays where it is. Each round
/// looks at what the last one has changed: of all else it is known that it crosses nothing, or cannot be
/// helped.
void limit(const SolidSurface& surface, std::vector<Vec3>& shift) {
  const TriangleMesh& mesh = surface.mesh;
  if (std::all_of(shift.begin(), shift.end(), [](const Vec3& s) { return s.isZero(0.0); })) return;
  // Most of a large piece is far from its new faces.
  const std::vector<int> near = triangles_in(mesh, reach_of(mesh, shift));
  std::vector<Triangle> near_corners;
  for (const int t : near) near_corners.push_back(mesh.triangles[at(t)]);
  const BoxedMesh still(mesh.positions, near_corners);
  for (Size v = 0; v < shift.size(); ++v)
    if (!shift[v].isZero(0.0))
      shift[v] *= kShareOfWidth * way_to_face(still, static_cast<int>(v), shift[v], 1.0 / kShareOfWidth);
  std::vector<Vec3> positions = mesh.positions;
  BoxedMesh moved(positions, still);
  std::vector<char> has_changed(shift.size(), 0);
  for (Size v = 0; v < shift.size(); ++v) has_changed[v] = shift[v].isZero(0.0) ? 0 : 1;
  for (int round = 0; round < 2 * kHalvings; ++round) {
    core::stop_if_asked();
    const std::vector<int> changed = triangles_at(mesh, has_changed);
    if (changed.empty()) return;
    for (Size v = 0; v < shift.size(); ++v) positions[v] = mesh.positions[v] + shift[v];
    moved.update();
    std::vector<Triangle> corners;
    for (const int t : changed) corners.push_back(mesh.triangles[at(t)]);
    const BoxedMesh own(positions, std::move(corners));
    std::vector<char> is_marked(shift.size(), 0);
    const auto mark = [&](int triangle) {
      for (const int v : mesh.triangles[at(triangle)]) is_marked[at(v)] = 1;
    };
    for_crossing(
        own, still,
        [&](int, int b) {
          const Size t = at(near[at(b)]);
          return !surface.is_crack_face[t] || surface.is_old_face[t];
        },
        [&](int a, int) { mark(changed[at(a)]); });
    for_crossing(
        own, moved, [&](int a, int b) { return changed[at(a)] == near[at(b)]; },
        [&](int a, int b) {
          mark(changed[at(a)]);
          mark(near[at(b)]);
        });
    has_changed.assign(shift.size(), 0);
    for (Size v = 0; v < shift.size(); ++v) {
      if (is_marked[v] == 0 || shift[v].isZero(0.0)) continue;
      shift[v] *= round < kHalvings ? 0.5 : 0.0;
      has_changed[v] = 1;
    }
  }
}

/// 1 for vertices that touch others of the same surface.
std::vector<char> find_shared_vertices(const SolidSurface& surface) {
  std::map<int, int> count;  // by vertex of the complex
  for (const int source : surface.vertex_sources) ++count[source];
  std::vector<char> is_shared;
  for (const int source : surface.vertex_sources) is_shared.push_back(source >= 0 && count.at(source) > 1);
  return is_shared;
}

/// Where the tips of two hollows in the material touch, neither has room to go back, and what fills them goes
/// back into itself: they stay. Sets their shifts to zero and says which they are.
std::vector<char> find_tips_of_hollows(const SolidSurface& surface, const std::vector<char>& is_shared,
                                       std::vector<Vec3>& shift) {
  const TriangleMesh& mesh = surface.mesh;
  std::vector<Vec3> ahead(shift.size(), Vec3::Zero());  // where a vertex' faces are, seen from it
  for (const Triangle& t : mesh.triangles)
    for (Size i = 0; i < 3; ++i) {
      const Vec3 way = mesh.positions[at(t[(i + 1) % 3])] - mesh.positions[at(t[i])];
      const double length = way.norm();
      if (length > 0.0) ahead[at(t[i])] += way / length;
    }
  std::vector<char> stays(shift.size(), 0);
  for (Size v = 0; v < is_shared.size(); ++v) {
    if (is_shared[v] == 0 || !(ahead[v].dot(shift[v]) < 0.0)) continue;
    stays[v] = 1;
    shift[v].setZero();
  }
  return stays;
}

/// Vertices of crack faces that have stood back before, to which keep_kerf could give no place in these, get
/// that on the whole's surface which is nearest to where they would stand back to from them alone.
void take_places(const SurfaceDistance& whole, SolidSurface& surface, double kerf) {
  const TriangleMesh& mesh = surface.mesh;
  VertexFaces faces{std::vector<std::vector<Vec3>>(mesh.positions.size()),
                    std::vector<std::vector<Vec3>>(mesh.positions.size())};
  for (Size t = 0; t < mesh.triangles.size(); ++t) {
    if (surface.is_crack_face[t] && !surface.is_old_face[t]) continue;
    const std::optional<Vec3> normal = find_normal(mesh, mesh.triangles[t]);
    if (!normal) continue;
    for (const int v : mesh.triangles[t])
      if (!surface.has_kerf[at(v)])
        add_normal(faces.cracks[at(v)], faces.outers[at(v)], surface.is_old_face[t] != 0, *normal);
  }
  for (Size v = 0; v < faces.cracks.size(); ++v) {
    if (faces.cracks[v].empty()) continue;
    const Vec3 place = mesh.positions[v] + retreat(faces.cracks[v], faces.outers[v], kerf);
    const NearestPlace nearest = whole.find(place, kFarthest * kerf);
    if (nearest.triangle < 0) continue;
    surface.mesh.positions[v] = nearest.place;
    surface.has_kerf[v] = 1;
  }
}

/// Walls that are planes where they have stood back to stay such; others are of separate facets from now on.
void keep_planes(SolidComplex& piece, const SolidSurface& surface) {
  struct Wall {
    std::vector<int> triangles;
    std::optional<Vec3> normal;
    double area = 0.0;
  };
  std::map<std::array<int, 2>, Wall> walls;  // by tag and plane
  const TriangleMesh& mesh = surface.mesh;
  for (Size t = 0; t < mesh.triangles.size(); ++t) {
    if (!surface.is_crack_face[t] || surface.triangle_facets[t] < 0) continue;
    const SolidFacet& facet = piece.facets[at(surface.triangle_facets[t])];
    if (facet.plane < 0) continue;
    Wall& wall = walls[{facet.tag, facet.plane}];
    wall.triangles.push_back(static_cast<int>(t));
    const Vec3& a = mesh.positions[at(mesh.triangles[t][0])];
    const double area = (mesh.positions[at(mesh.triangles[t][1])] - a)
                            .cross(mesh.positions[at(mesh.triangles[t][2])] - a)
                            .norm();
    if (!(area > wall.area)) continue;
    wall.area = area;
    wall.normal = find_normal(mesh, mesh.triangles[t]);
  }
  const auto is_plane = [&](const Wall& wall) {
    if (!wall.normal) return false;
    const Vec3& origin = mesh.positions[at(mesh.triangles[at(wall.triangles[0])][0])];
    double off = 0.0, extent = 0.0;
    for (const int t : wall.triangles)
      for (const int v : mesh.triangles[at(t)]) {
        off = std::max(off, std::abs(wall.normal->dot(mesh.positions[at(v)] - origin)));
        extent = std::max(extent, (mesh.positions[at(v)] - origin).norm());
      }
    return off <= kFlatWall * extent;
  };
  std::erase_if(walls, [&](const auto& wall) { return !is_plane(wall.second); });
  for (const int f : find_border_facets(piece)) {
    SolidFacet& facet = piece.facets[at(f)];
    if (facet.plane < 0) continue;
    if (facet.kind == FacetKind::crack) facet.kind = FacetKind::old_crack;
    if (!walls.contains({facet.tag, facet.plane})) facet.plane = -1;
  }
}

/// Parts the border's crack facets along the edges of the surface's triangles, which no longer lie in one
/// plane.
void divide_crack_facets(SolidComplex& piece, const SolidSurface& surface) {
  std::map<int, std::vector<std::array<int, 2>>> sides;  // by facet: its triangles' sides, ends ascending
  for (Size t = 0; t < surface.mesh.triangles.size(); ++t) {
    if (!surface.is_crack_face[t] || surface.triangle_facets[t] < 0) continue;
    for (Size i = 0; i < 3; ++i) {
      const Triangle& triangle = surface.mesh.triangles[t];
      const auto [low, high] = std::minmax(surface.vertex_sources[at(triangle[i])],
                                           surface.vertex_sources[at(triangle[(i + 1) % 3])]);
      sides[surface.triangle_facets[t]].push_back({low, high});
    }
  }
  for (auto& [facet, own] : sides) {
    piece.facets[at(facet)].kind = FacetKind::old_crack;
    if (piece.facets[at(facet)].plane >= 0) continue;
    std::sort(own.begin(), own.end());
    std::vector<int> parts{facet};
    for (Size i = 0; i + 1 < own.size(); ++i) {
      if (own[i] != own[i + 1] || own[i][0] < 0) continue;
      for (Size p = 0; p < parts.size(); ++p) {
        std::array<int, 2> places{-1, -1};
        const SolidFacet& part = piece.facets[at(parts[p])];
        for (int k = 0; k < part.side_count; ++k)
          for (Size end = 0; end < 2; ++end)
            if (piece.side_begin(piece.sides_of(part)[k]) == own[i][end]) places[end] = k;
        const auto [begin, end] = std::minmax(places[0], places[1]);
        if (begin < 0 || end - begin < 2 || end - begin > part.side_count - 2) continue;
        const std::array<int, 2> halves = divide_facet(piece, parts[p], begin, end);
        parts[p] = halves[0];
        parts.push_back(halves[1]);
        break;
      }
    }
  }
  settle(piece);
}

}  // namespace

double stand_back(SolidSurface& surface, double kerf, const SurfaceDistance* whole) {
  const std::vector<char> is_shared = find_shared_vertices(surface);
  part_vertices(surface, kerf);
  if (whole) take_places(*whole, surface, kerf);
  const VertexFaces faces = collect_faces(surface);
  std::vector<Vec3> shift(surface.mesh.positions.size(), Vec3::Zero());
  for (Size v = 0; v < faces.cracks.size(); ++v)
    if (!faces.cracks[v].empty()) shift[v] = retreat(faces.cracks[v], faces.outers[v], kerf);
  const std::vector<char> stays = find_tips_of_hollows(surface, is_shared, shift);
  limit(surface, shift);
  double least = kerf;
  for (Size v = 0; v < faces.cracks.size(); ++v) {
    surface.mesh.positions[v] += shift[v];
    if (stays[v] == 0)
      for (const Vec3& normal : faces.cracks[v]) least = std::min(least, -normal.dot(shift[v]));
  }
  return least > 0.0 ? least : 0.0;
}

void keep_kerf(SolidComplex& piece, const SolidSurface& surface) {
  const std::vector<Vec3>& positions = surface.mesh.positions;
  std::vector<int> own(piece.vertices.size(), -1);  // of the complex's vertices: the surface's, -2: several
  for (Size v = 0; v < positions.size(); ++v) {
    const int source = surface.vertex_sources[v];
    if (source >= 0) own[at(source)] = own[at(source)] == -1 ? static_cast<int>(v) : -2;
  }
  const auto set = [&](int source, const Vec3& place) {
    SolidVertex& vertex = piece.vertices[at(source)];
    vertex.kerf = place - vertex.position;
    vertex.has_kerf = true;
  };
  for (Size s = 0; s < own.size(); ++s) {
    piece.vertices[s].kerf.setZero();
    piece.vertices[s].has_kerf = false;
    if (own[s] >= 0) set(static_cast<int>(s), positions[at(own[s])]);
  }
  for (const SolidSurface::OnEdge& on : surface.on_edges) {
    const bool is_known = [&](int v) {
      const int source = surface.vertex_sources[at(v)];
      return source >= 0 && own[at(source)] == v;
    }(on.from) && own[at(surface.vertex_sources[at(on.to)])] == on.to;
    if (is_known && own[at(on.source)] == -1)
      set(on.source, positions[at(on.from)] + on.share * (positions[at(on.to)] - positions[at(on.from)]));
  }
  keep_planes(piece, surface);
  divide_crack_facets(piece, surface);
}

}  // namespace shatterbox::geometry
