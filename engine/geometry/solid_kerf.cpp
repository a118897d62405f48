#include "engine/geometry/solid_kerf.h"

#include <algorithm>
#include <cmath>

#include "engine/core/index.h"
#include "engine/geometry/bvh.h"
#include "engine/geometry/crossings.h"

namespace shatterbox::geometry {
namespace {

using Size = std::size_t;
using core::at;

constexpr double kSamePlane = 0.9999;    // cosine: crack faces that turn by less are one
constexpr double kSameFace = 0.87;       // cosine: outer faces that turn by less are one curved one
constexpr double kLongestRetreat = 4.0;  // kerfs: how far a sharp corner retreats along its bisector
constexpr double kShareOfWidth = 0.25;   // of the material's width: the most that a vertex retreats
constexpr int kHalvings = 24;            // rounds in which a kerf that is still too wide is halved
constexpr int kSweeps = 200;

/// normal . shift <= bound, or equal to it.
struct Plane {
  Vec3 normal;  // unit, outward
  double bound;
  bool is_equality;
};

/// The shortest shift that keeps to all planes, by Hildreth's method; the last one where there is none.
Vec3 shortest_shift(const std::vector<Plane>& planes, double tolerance) {
  Vec3 shift = Vec3::Zero();
  std::vector<double> multipliers(planes.size(), 0.0);
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    double change = 0.0;
    for (Size i = 0; i < planes.size(); ++i) {
      double step = planes[i].normal.dot(shift) - planes[i].bound;
      if (!planes[i].is_equality) step = std::max(step, -multipliers[i]);
      multipliers[i] += step;
      shift -= step * planes[i].normal;
      change = std::max(change, std::abs(step));
    }
    if (change <= tolerance) break;
  }
  return shift;
}

/// What the faces about each vertex ask of its shift: planes of crack faces, and of outer ones.
struct VertexFaces {
  std::vector<std::vector<Vec3>> cracks, outers;
};

void add_normal(std::vector<Vec3>& normals, const Vec3& normal) {
  for (const Vec3& n : normals)
    if (n.dot(normal) > kSamePlane) return;
  normals.push_back(normal);
}

VertexFaces collect_faces(const SolidSurface& surface) {
  const TriangleMesh& mesh = surface.mesh;
  VertexFaces faces{std::vector<std::vector<Vec3>>(mesh.positions.size()),
                    std::vector<std::vector<Vec3>>(mesh.positions.size())};
  std::vector<char> is_at_crack(mesh.positions.size(), 0);
  for (Size t = 0; t < mesh.triangles.size(); ++t)
    if (surface.is_crack_face[t])
      for (const int v : mesh.triangles[t]) is_at_crack[at(v)] = 1;
  for (Size t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = mesh.triangles[t];
    if (!is_at_crack[at(a)] && !is_at_crack[at(b)] && !is_at_crack[at(c)]) continue;
    const Vec3 ab = mesh.positions[at(b)] - mesh.positions[at(a)];
    const Vec3 ac = mesh.positions[at(c)] - mesh.positions[at(a)];
    const Vec3 normal = ab.cross(ac);
    const double size = normal.norm();
    if (!(size > 1e-14 * (ab.squaredNorm() + ac.squaredNorm()))) continue;
    for (const int v : mesh.triangles[t])
      if (is_at_crack[at(v)])
        add_normal((surface.is_crack_face[t] ? faces.cracks : faces.outers)[at(v)], normal / size);
  }
  return faces;
}

/// How far, and where to, a vertex retreats from crack faces; zero where no way leads inwards.
Vec3 retreat(const std::vector<Vec3>& cracks, const std::vector<Vec3>& outers, double kerf) {
  std::vector<Plane> planes, outer_faces;
  for (const Vec3& normal : cracks) planes.push_back({normal, -kerf, false});
  for (const Vec3& normal : outers) {
    planes.push_back({normal, 0.0, false});
    const bool is_known = std::any_of(outer_faces.begin(), outer_faces.end(),
                                      [&](const Plane& face) { return face.normal.dot(normal) > kSameFace; });
    if (!is_known) outer_faces.push_back({normal, 0.0, true});
  }
  const double tolerance = 1e-7 * kerf;
  const auto bounded = [&](Vec3 shift) {
    const double length = shift.norm();
    if (length > kLongestRetreat * kerf) shift *= kLongestRetreat * kerf / length;
    return shift;
  };
  const auto leads_in = [&](const Vec3& shift) {
    return std::all_of(planes.begin(), planes.end(), [&](const Plane& plane) {
      return plane.normal.dot(shift) <= (plane.bound < 0.0 ? -1e-3 * kerf : tolerance * 2.0);
    });
  };
  std::vector<Plane> all = planes;
  all.insert(all.end(), outer_faces.begin(), outer_faces.end());
  const Vec3 along = bounded(shortest_shift(all, tolerance));
  if (leads_in(along)) return along;
  const Vec3 inward = bounded(shortest_shift(planes, tolerance));  // a corner of the outer surface gives way
  return leads_in(inward) ? inward : Vec3::Zero();
}

/// Triangles, with boxes about them for one state of their vertices.
struct BoxedMesh {
  std::vector<Vec3> positions;
  std::vector<Triangle> triangles;
  TriangleTree tree;
  std::vector<Box> boxes;

  BoxedMesh(std::vector<Vec3> p, std::vector<Triangle> t)
      : positions(std::move(p)), triangles(std::move(t)), tree(build_triangle_tree(positions, triangles)) {
    update();
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
                           if (are_exempt(ta, tb)) continue;
                           if (an_edge_passes(a, first, b, second) || an_edge_passes(b, second, a, first))
                             visit(ta, tb);
                         }
                     });
}

/// Where a way from a vertex first meets a face that is not at the vertex, its border included, in lengths of
/// the way; `most` if nowhere before that.
double way_to_face(const BoxedMesh& mesh, int vertex, const Vec3& way, double most) {
  constexpr double kParallel = 1e-9, kSlack = 1e-6;
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
      if (b >= -kSlack && c >= -kSlack && b + c <= 1.0 + kSlack) nearest = length;
    }
  }
  return nearest;
}

/// Shortens shifts to a quarter of the material's width in their direction; then halves what leads a moved
/// face through a crack face or another moved one. What cannot be helped so stays where it is.
void limit(const SolidSurface& surface, std::vector<Vec3>& shift) {
  const TriangleMesh& mesh = surface.mesh;
  const BoxedMesh still(mesh.positions, mesh.triangles);
  for (Size v = 0; v < shift.size(); ++v)
    if (!shift[v].isZero(0.0))
      shift[v] *= kShareOfWidth * way_to_face(still, static_cast<int>(v), shift[v], 1.0 / kShareOfWidth);
  BoxedMesh moved(mesh.positions, mesh.triangles);
  for (int round = 0; round < 2 * kHalvings; ++round) {
    for (Size v = 0; v < shift.size(); ++v) moved.positions[v] = mesh.positions[v] + shift[v];
    moved.update();
    std::vector<char> is_marked(shift.size(), 0);
    const auto mark = [&](int triangle) {
      for (const int v : mesh.triangles[at(triangle)]) is_marked[at(v)] = 1;
    };
    for_crossing(
        moved, still, [&](int, int b) { return !surface.is_crack_face[at(b)]; },
        [&](int a, int) { mark(a); });
    for_crossing(
        moved, moved, [](int a, int b) { return a >= b; },
        [&](int a, int b) {
          mark(a);
          mark(b);
        });
    bool is_fine = true;
    for (Size v = 0; v < shift.size(); ++v) {
      if (is_marked[v] == 0 || shift[v].isZero(0.0)) continue;
      shift[v] *= round < kHalvings ? 0.5 : 0.0;
      is_fine = false;
    }
    if (is_fine) return;
  }
}

}  // namespace

double stand_back(SolidSurface& surface, double kerf) {
  const VertexFaces faces = collect_faces(surface);
  std::vector<Vec3> shift(surface.mesh.positions.size(), Vec3::Zero());
  for (Size v = 0; v < faces.cracks.size(); ++v)
    if (!faces.cracks[v].empty()) shift[v] = retreat(faces.cracks[v], faces.outers[v], kerf);
  limit(surface, shift);
  double least = kerf;
  for (Size v = 0; v < faces.cracks.size(); ++v) {
    surface.mesh.positions[v] += shift[v];
    for (const Vec3& normal : faces.cracks[v]) least = std::min(least, -normal.dot(shift[v]));
  }
  return least > 0.0 ? least : 0.0;
}

}  // namespace shatterbox::geometry
