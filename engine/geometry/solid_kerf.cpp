#include "engine/geometry/solid_kerf.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/core/disjoint_sets.h"
#include "engine/core/index.h"

namespace shatterbox::geometry {
namespace {

using Size = std::size_t;
using core::at;

constexpr double kSamePlane = 0.9999;    // cosine: crack faces that turn by less are one
constexpr double kSameFace = 0.87;       // cosine: outer faces that turn by less are one curved one
constexpr double kLongestRetreat = 4.0;  // kerfs: how far a sharp corner retreats along its bisector
constexpr double kLeastKept = 0.5;       // of a part's volume: two kerfs from two sides, each a quarter of it
constexpr double kLeastArea = 0.2;       // of an outer triangle's area
constexpr int kPropagations = 3;         // rounds in which vertices inside move along with the surface
constexpr int kHalvings = 12;            // rounds in which a kerf that is still too wide is halved
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

/// The parts of a piece that must keep their orientation while its surface moves: cones from the middles of
/// cells to their facets' triangles. "Slots" are the surface's vertices, then the complex' vertices inside.
class Guard {
 public:
  Guard(const SolidSurface& surface, const SolidComplex& piece) : surface_(surface), piece_(piece) {
    number_slots();
    collect_triangles();
    collect_corners();
  }

  Size slot_count() const { return positions_.size(); }
  bool is_border(int slot) const { return at(slot) < surface_.mesh.positions.size(); }
  /// True for vertices in which one part's border touches itself from within (the tip of a cone with a
  /// conical pit): there is no room to move in.
  bool is_stuck(int slot) const { return is_stuck_[at(slot)] != 0; }

  /// Shortens shifts to half of how far the cells about a vertex reach in their direction, so that no small
  /// piece leaves its place as a whole.
  void keep_within_cells(std::vector<Vec3>& shift) const {
    std::vector<double> reach(shift.size(), 0.0);  // in shifts
    for (Size c = 0; c < piece_.cells.size(); ++c)
      for (int i = first_corner_[c]; i < first_corner_[c + 1]; ++i) {
        const Size s = at(corners_[at(i)]);
        const double squared = shift[s].squaredNorm();
        if (!(squared > 0.0)) continue;
        for (int k = first_corner_[c]; k < first_corner_[c + 1]; ++k)
          reach[s] =
              std::max(reach[s], shift[s].dot(positions_[at(corners_[at(k)])] - positions_[s]) / squared);
      }
    for (Size s = 0; s < shift.size(); ++s) shift[s] *= std::min(1.0, 0.5 * reach[s]);
  }

  /// Calls visit(slots of the triangle, first slot of the cell, last slot) for each cone that would keep less
  /// than kLeastKept of its volume.
  template <class Visit>
  void for_collapsed(const std::vector<Vec3>& shift, const Visit& visit) const {
    for (Size c = 0; c < piece_.cells.size(); ++c) {
      const int* first = corners_.data() + first_corner_[c];
      const int* last = corners_.data() + first_corner_[c + 1];
      if (std::all_of(first, last, [&](int s) { return shift[at(s)].isZero(0.0); })) continue;
      Vec3 middle = Vec3::Zero(), middle_shift = Vec3::Zero();
      for (const int* s = first; s != last; ++s) {
        middle += positions_[at(*s)];
        middle_shift += shift[at(*s)];
      }
      middle /= static_cast<double>(last - first);
      middle_shift /= static_cast<double>(last - first);
      for (int t = first_triangle_[c]; t < first_triangle_[c + 1]; ++t) {
        const auto& slots = triangles_[at(t)];
        const auto volume = [&](double way) {
          const auto p = [&](Size k) {
            return Vec3(positions_[at(slots[k])] - middle + way * (shift[at(slots[k])] - middle_shift));
          };
          return p(0).dot(p(1).cross(p(2)));
        };
        const double least = kLeastKept * volume(0.0);
        // On the way, too: what was turned over twice is not whole.
        if (least > 0.0 &&
            !(volume(0.25) >= least && volume(0.5) >= least && volume(0.75) >= least && volume(1.0) >= least))
          visit(slots, first, last);
      }
    }
  }

  /// Calls visit(triangle) for each triangle of the outer surface that would lose most of its area or turn
  /// over.
  template <class Visit>
  void for_collapsed_outer(const std::vector<Vec3>& shift, const Visit& visit) const {
    for (Size t = 0; t < surface_.mesh.triangles.size(); ++t) {
      const Triangle& slots = surface_.mesh.triangles[t];
      if (surface_.is_crack_face[t] ||
          std::all_of(slots.begin(), slots.end(), [&](int s) { return shift[at(s)].isZero(0.0); }))
        continue;
      const auto area = [&](double way) {
        const auto p = [&](Size k) { return Vec3(positions_[at(slots[k])] + way * shift[at(slots[k])]); };
        return Vec3((p(1) - p(0)).cross(p(2) - p(0)));
      };
      const Vec3 before = area(0.0);
      if (!(area(1.0).dot(before) >= kLeastArea * before.squaredNorm())) visit(slots);
    }
  }

 private:
  struct Place {
    int vertex, cell;
    bool operator<(const Place& other) const {
      return vertex != other.vertex ? vertex < other.vertex : cell < other.cell;
    }
    bool operator==(const Place& other) const { return vertex == other.vertex && cell == other.cell; }
  };

  void number_slots() {
    positions_ = surface_.mesh.positions;
    slot_of_vertex_.assign(piece_.vertices.size(), -1);
    constexpr int kSeveral = -2;
    is_stuck_.assign(positions_.size(), 0);
    for (Size s = 0; s < surface_.vertex_sources.size(); ++s) {
      is_stuck_[s] = surface_.vertex_sources[s] < 0;
      if (is_stuck_[s]) continue;
      int& slot = slot_of_vertex_[at(surface_.vertex_sources[s])];
      slot = slot == -1 ? static_cast<int>(s) : kSeveral;
    }
    if (std::find(slot_of_vertex_.begin(), slot_of_vertex_.end(), kSeveral) != slot_of_vertex_.end())
      collect_places(kSeveral);
    for (Size v = 0; v < slot_of_vertex_.size(); ++v) {
      if (slot_of_vertex_[v] != -1) continue;
      slot_of_vertex_[v] = static_cast<int>(positions_.size());
      positions_.push_back(piece_.vertices[v].position);
    }
  }

  /// Calls visit(facet, its cell, the surface's vertices at its corners) for each facet of the border.
  template <class Visit>
  void for_border(const Visit& visit) const {
    for (const BorderFacet& border : surface_.border_facets) {
      const SolidFacet& facet = piece_.facets[at(border.facet)];
      visit(facet, std::max(facet.cells[0], facet.cells[1]),
            surface_.corner_vertices.data() + border.first_corner);
    }
  }

  /// Which copy of a vertex that the surface has several times belongs to which cell: the one of the border
  /// that is reached through the cells about the vertex.
  void collect_places(int several) {
    const auto for_corners = [&](auto&& visit) {
      for (const SolidFacet& facet : piece_.facets)
        for (int i = 0; i < facet.side_count; ++i) {
          const int v = piece_.side_begin(piece_.sides_of(facet)[i]);
          if (slot_of_vertex_[at(v)] == several) visit(facet, v);
        }
    };
    for_corners([&](const SolidFacet& facet, int v) {
      for (const int cell : facet.cells)
        if (cell >= 0) places_.push_back({v, cell});
    });
    std::sort(places_.begin(), places_.end());
    places_.erase(std::unique(places_.begin(), places_.end()), places_.end());
    core::DisjointSets together(places_.size());
    for_corners([&](const SolidFacet& facet, int v) {
      if (facet.cells[0] >= 0 && facet.cells[1] >= 0)
        together.unite(place_of(v, facet.cells[0]), place_of(v, facet.cells[1]));
    });
    slot_of_place_.assign(places_.size(), -1);
    for_border([&](const SolidFacet& facet, int cell, const int* vertices) {
      for (int i = 0; i < facet.side_count; ++i) {
        const int v = piece_.side_begin(piece_.sides_of(facet)[i]);
        if (vertices[i] < 0 || slot_of_vertex_[at(v)] != several) continue;
        int& slot = slot_of_place_[at(together.find(place_of(v, cell)))];
        if (slot >= 0 && slot != vertices[i]) is_stuck_[at(slot)] = is_stuck_[at(vertices[i])] = 1;
        slot = vertices[i];
      }
    });
    for (Size p = 0; p < places_.size(); ++p) {
      slot_of_place_[p] = slot_of_place_[at(together.find(static_cast<int>(p)))];
      if (slot_of_place_[p] >= 0) continue;  // no corner of the surface is reached through this cell
      slot_of_place_[p] = static_cast<int>(positions_.size());
      positions_.push_back(piece_.vertices[at(places_[p].vertex)].position);
    }
  }

  int place_of(int vertex, int cell) const {
    return static_cast<int>(std::lower_bound(places_.begin(), places_.end(), Place{vertex, cell}) -
                            places_.begin());
  }

  int slot_of(int vertex, int cell) const {
    const int slot = slot_of_vertex_[at(vertex)];
    return slot >= 0 ? slot : slot_of_place_[at(place_of(vertex, cell))];
  }

  /// Triangles by cell, outward: those of the surface's crack faces, fans of all other facets.
  void collect_triangles() {
    std::vector<int> count(piece_.cells.size() + 1, 0);
    const auto fan_count = [](const SolidFacet& facet) { return std::max(facet.side_count - 2, 0); };
    const auto is_inside = [](const SolidFacet& facet) {
      return facet.parts[0] < 0 && facet.cells[0] >= 0 && facet.cells[1] >= 0;
    };
    for (const SolidFacet& facet : piece_.facets)
      if (is_inside(facet))
        for (const int cell : facet.cells) count[at(cell) + 1] += fan_count(facet);
    for_border([&](const SolidFacet& facet, int cell, const int*) {
      if (facet.kind == FacetKind::outer) count[at(cell) + 1] += fan_count(facet);
    });
    for (Size t = 0; t < surface_.mesh.triangles.size(); ++t)
      if (surface_.is_crack_face[t]) ++count[at(surface_.triangle_cells[t]) + 1];
    for (Size c = 1; c < count.size(); ++c) count[c] += count[c - 1];
    first_triangle_ = count;
    triangles_.resize(at(count.back()));
    const auto add_fan = [&](const SolidFacet& facet, int side, const int* vertices) {
      const int cell = facet.cells[at(side)];
      const auto slot = [&](int i) {
        return vertices && vertices[i] >= 0 ? vertices[i]
                                            : slot_of(piece_.side_begin(piece_.sides_of(facet)[i]), cell);
      };
      for (int i = 1; i + 1 < facet.side_count; ++i) {
        const int a = slot(0), b = slot(i), c = slot(i + 1);
        triangles_[at(count[at(cell)]++)] = side == 0 ? Triangle{a, b, c} : Triangle{a, c, b};
      }
    };
    for (const SolidFacet& facet : piece_.facets)
      if (is_inside(facet))
        for (const int side : {0, 1}) add_fan(facet, side, nullptr);
    for_border([&](const SolidFacet& facet, int, const int* vertices) {
      if (facet.kind == FacetKind::outer) add_fan(facet, facet.cells[0] >= 0 ? 0 : 1, vertices);
    });
    for (Size t = 0; t < surface_.mesh.triangles.size(); ++t)
      if (surface_.is_crack_face[t])
        triangles_[at(count[at(surface_.triangle_cells[t])]++)] = surface_.mesh.triangles[t];
  }

  void collect_corners() {
    first_corner_.push_back(0);
    for (Size c = 0; c < piece_.cells.size(); ++c) {
      const auto begin = static_cast<std::ptrdiff_t>(corners_.size());
      for (int t = first_triangle_[c]; t < first_triangle_[c + 1]; ++t)
        corners_.insert(corners_.end(), triangles_[at(t)].begin(), triangles_[at(t)].end());
      std::sort(corners_.begin() + begin, corners_.end());
      corners_.erase(std::unique(corners_.begin() + begin, corners_.end()), corners_.end());
      first_corner_.push_back(static_cast<int>(corners_.size()));
    }
  }

  const SolidSurface& surface_;
  const SolidComplex& piece_;
  std::vector<Vec3> positions_;  // of the slots
  std::vector<char> is_stuck_;   // per vertex of the surface
  std::vector<int> slot_of_vertex_;
  std::vector<Place> places_;  // of vertices that the surface has several times, ascending
  std::vector<int> slot_of_place_;
  std::vector<int> first_triangle_;  // |cells| + 1
  std::vector<Triangle> triangles_;
  std::vector<int> first_corner_;  // |cells| + 1
  std::vector<int> corners_;
};

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

/// Keeps every cone's orientation. Vertices inside first move along with the surface, so that slivers beside
/// it do not narrow the kerf; what still does not fit is halved.
void limit(const Guard& guard, std::vector<Vec3>& shift) {
  std::vector<char> is_marked(shift.size());
  for (int round = 0; round < kPropagations + kHalvings + 100; ++round) {
    bool is_fine = true;
    if (round < kPropagations) {
      std::vector<Vec3> moved = shift;
      guard.for_collapsed(shift, [&](const Triangle&, const int* first, const int* last) {
        is_fine = false;
        Vec3 largest = Vec3::Zero();
        for (const int* s = first; s != last; ++s)
          if (shift[at(*s)].squaredNorm() > largest.squaredNorm()) largest = shift[at(*s)];
        for (const int* s = first; s != last; ++s)
          if (!guard.is_border(*s) && moved[at(*s)].squaredNorm() < largest.squaredNorm())
            moved[at(*s)] = largest;
      });
      shift = moved;
    } else {
      std::fill(is_marked.begin(), is_marked.end(), 0);
      guard.for_collapsed(shift, [&](const Triangle& slots, const int* first, const int* last) {
        is_fine = false;
        // The middle moves with all corners.
        const bool is_own =
            std::any_of(slots.begin(), slots.end(), [&](int s) { return !shift[at(s)].isZero(0.0); });
        if (is_own)
          for (const int s : slots) is_marked[at(s)] = 1;
        else
          for (const int* s = first; s != last; ++s) is_marked[at(*s)] = 1;
      });
      guard.for_collapsed_outer(shift, [&](const Triangle& slots) {
        is_fine = false;
        for (const int s : slots) is_marked[at(s)] = 1;
      });
      const double factor = round < kPropagations + kHalvings ? 0.5 : 0.0;
      for (Size s = 0; s < shift.size(); ++s)
        if (is_marked[s]) shift[s] *= factor;
    }
    if (is_fine && round >= kPropagations) return;
  }
}

}  // namespace

double stand_back(SolidSurface& surface, const SolidComplex& piece, double kerf) {
  const Guard guard(surface, piece);
  const VertexFaces faces = collect_faces(surface);
  std::vector<Vec3> shift(guard.slot_count(), Vec3::Zero());
  for (Size v = 0; v < faces.cracks.size(); ++v)
    if (!faces.cracks[v].empty() && !guard.is_stuck(static_cast<int>(v)))
      shift[v] = retreat(faces.cracks[v], faces.outers[v], kerf);
  guard.keep_within_cells(shift);
  limit(guard, shift);
  double least = kerf;
  for (Size v = 0; v < faces.cracks.size(); ++v) {
    surface.mesh.positions[v] += shift[v];
    for (const Vec3& normal : faces.cracks[v]) least = std::min(least, -normal.dot(shift[v]));
  }
  return least > 0.0 ? least : 0.0;
}

}  // namespace shatterbox::geometry
