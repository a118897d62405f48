#include "engine/geometry/lattice_warp.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "engine/core/elementary.h"
#include "engine/core/index.h"
#include "engine/geometry/surface_distance.h"
#include "engine/geometry/tet_quality.h"

namespace shatterbox::geometry {
namespace {

using Size = std::size_t;
using core::at;

constexpr double kReach = 0.3;  // of a cell: vertices nearer to the surface are moved to it
// How far outside they come to lie, of a cell: at first, and where the surface bulges between them.
constexpr std::array<double, 3> kOffsets{0.015, 0.05, 0.15};
constexpr double kLeastDihedral = 25.0 * core::kPi / 180.0;
constexpr double kGreatestDihedral = 140.0 * core::kPi / 180.0;

class LatticeWarp {
 public:
  LatticeWarp(SolidElements& elements, const SurfaceCrossings& crossings, const TriangleMesh& surface,
              double cell_size)
      : elements_(elements),
        is_inside_(crossings.is_inside),
        original_(elements.mesh.positions),
        surface_(surface),
        distance_(surface),
        cell_size_(cell_size) {
    find_moves(crossings);
    const auto& tetrahedra = elements_.mesh.tetrahedra;
    first_.assign(original_.size() + 1, 0);
    for (const Tetrahedron& t : tetrahedra)
      for (const int v : t) ++first_[at(v) + 1];
    for (Size v = 1; v < first_.size(); ++v) first_[v] += first_[v - 1];
    around_.resize(at(first_.back()));
    std::vector<int> next(first_.begin(), first_.end() - 1);
    for (Size t = 0; t < tetrahedra.size(); ++t)
      for (const int v : tetrahedra[t]) around_[at(next[at(v)]++)] = static_cast<int>(t);
  }

  /// The nearest vertices first: they have the least way to go.
  void move_all() {
    for (Move& move : moves_) move.is_done = move_vertex(move);
  }

  /// Vertices of tetrahedra that hold material though none of their corners is inside go farther out. False
  /// if none could.
  bool push_out(const SurfaceCrossings& crossings) {
    std::vector<std::uint8_t> is_in_the_way(original_.size(), 0);
    for (Size t = 0; t < elements_.mesh.tetrahedra.size(); ++t) {
      const Tetrahedron& corners = elements_.mesh.tetrahedra[t];
      if (!crossings.has_material[t] ||
          std::any_of(corners.begin(), corners.end(), [&](int v) { return crossings.is_inside[at(v)] != 0; }))
        continue;
      for (const int v : corners) is_in_the_way[at(v)] = 1;
    }
    bool has_moved = false;
    for (Move& move : moves_) {
      if (!is_in_the_way[at(move.vertex)] || !move.is_done || move.step + 1 == kOffsets.size()) continue;
      ++move.step;
      has_moved |= move_vertex(move);
    }
    return has_moved;
  }

 private:
  struct Move {
    int vertex;
    double distance;  // m
    Vec3 place, outward;
    std::size_t step = 0;  // in kOffsets
    bool is_done = false;
  };

  void find_moves(const SurfaceCrossings& crossings) {
    std::vector<std::uint8_t> is_near(original_.size(), 0);
    for (Size t = 0; t < elements_.mesh.tetrahedra.size(); ++t)
      if (crossings.has_material[t])
        for (const int v : elements_.mesh.tetrahedra[t]) is_near[at(v)] = 1;
    for (Size v = 0; v < original_.size(); ++v) {
      if (!is_near[v]) continue;
      const NearestPlace nearest = distance_.find(original_[v], kReach * cell_size_);
      if (nearest.triangle < 0) continue;
      Vec3 outward = original_[v] - nearest.place;
      if (is_inside_[v]) outward = -outward;
      if (nearest.distance < 1e-6 * cell_size_) {
        const Triangle& t = surface_.triangles[at(nearest.triangle)];
        const Vec3& a = surface_.positions[at(t[0])];
        outward = (surface_.positions[at(t[1])] - a).cross(surface_.positions[at(t[2])] - a);
      }
      const double length = outward.norm();
      if (!(length > 0.0)) continue;
      moves_.push_back({static_cast<int>(v), nearest.distance, nearest.place, outward / length});
    }
    std::sort(moves_.begin(), moves_.end(), [](const Move& p, const Move& q) {
      return p.distance != q.distance ? p.distance < q.distance : p.vertex < q.vertex;
    });
  }

  bool move_vertex(const Move& move) {
    Vec3& position = elements_.mesh.positions[at(move.vertex)];
    const Vec3 before = position;
    position = move.place + kOffsets[move.step] * cell_size_ * move.outward;
    for (int k = first_[at(move.vertex)]; k < first_[at(move.vertex) + 1]; ++k)
      if (!is_well_shaped(around_[at(k)])) {
        position = before;
        return false;
      }
    return true;
  }

  /// By the nearest triangle: good enough for a guess.
  bool is_middle_inside(const Tetrahedron& corners) const {
    Vec3 middle = Vec3::Zero();
    for (const int v : corners) middle += 0.25 * elements_.mesh.positions[at(v)];
    const NearestPlace nearest = distance_.find(middle, cell_size_);
    if (nearest.triangle < 0) return false;
    const Triangle& t = surface_.triangles[at(nearest.triangle)];
    const Vec3& a = surface_.positions[at(t[0])];
    const Vec3 normal = (surface_.positions[at(t[1])] - a).cross(surface_.positions[at(t[2])] - a);
    return normal.dot(middle - nearest.place) < 0.0;
  }

  bool is_well_shaped(int tetrahedron) const {
    std::array<Vec3, 4> corners;
    for (Size k = 0; k < 4; ++k)
      corners[k] = elements_.mesh.positions[at(elements_.mesh.tetrahedra[at(tetrahedron)][k])];
    if (!(tetrahedron_volume(elements_.mesh, tetrahedron) > 0.0)) return false;
    const TetShape shape = tetrahedron_shape(corners);
    const auto [least, greatest] = std::minmax_element(shape.dihedrals.begin(), shape.dihedrals.end());
    return *least >= kLeastDihedral && *greatest <= kGreatestDihedral;
  }

  SolidElements& elements_;
  const std::vector<std::uint8_t> is_inside_;
  const std::vector<Vec3> original_;
  const TriangleMesh& surface_;
  const SurfaceDistance distance_;
  double cell_size_;
  std::vector<int> first_, around_;  // tetrahedra of each vertex
  std::vector<Move> moves_;
};

}  // namespace

std::optional<std::string> warp_lattice(SolidElements& elements, SurfaceCrossings& crossings,
                                        const TriangleMesh& surface, const EdgeTopology& surface_edges,
                                        double cell_size) {
  LatticeWarp warp(elements, crossings, surface, cell_size);
  warp.move_all();
  do {
    core::Result<SurfaceCrossings> found = find_surface_crossings(elements, surface, surface_edges);
    if (!found) return found.error();
    crossings = std::move(found.value());
  } while (warp.push_out(crossings));
  return std::nullopt;
}

}  // namespace shatterbox::geometry
