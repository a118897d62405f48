#include "engine/geometry/tet_lattice.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "engine/core/index.h"
#include "engine/geometry/bvh.h"
#include "engine/geometry/generator_faults.h"

namespace shatterbox::geometry {
namespace {

using Size = std::size_t;
using core::at;
using Place = std::array<int, 3>;

/// Cubes, from the first to the last along each axis.
struct PlaceRange {
  Place first, last;

  template <class Visit>
  void each(const Visit& visit) const {
    Place p;
    for (p[0] = first[0]; p[0] <= last[0]; ++p[0])
      for (p[1] = first[1]; p[1] <= last[1]; ++p[1])
        for (p[2] = first[2]; p[2] <= last[2]; ++p[2]) visit(p);
  }
};

/// A block of cubes about a surface, with two cubes more on each side.
class CubeBlock {
 public:
  /// Of as many cubes along each edge as large ones of `most_level` take.
  CubeBlock(const Box& box, double cell_size, int most_level) : size_(cell_size) {
    for (int axis = 0; axis < 3; ++axis) {
      const double extent = box.high[axis] - box.low[axis];
      counts_[at(axis)] = static_cast<int>(std::ceil(extent / size_)) + 5;
      // About the middle, off it by different parts of a cell: what is round numbers there is none here, and
      // planes of symmetry are none of the lattice's.
      const double shift = std::array{0.1180339887, 0.0902113033, 0.1543689012}[at(axis)];
      origin_[axis] = 0.5 * (box.low[axis] + box.high[axis]) - (0.5 * counts_[at(axis)] + shift) * size_;
      counts_[at(axis)] = (((counts_[at(axis)] - 1) >> most_level) + 1) << most_level;
    }
    kinds_.assign(static_cast<Size>(counts_[0]) * at(counts_[1]) * at(counts_[2]), Kind::unknown);
  }

  /// Marks cubes that a triangle may touch.
  void add_triangle(const std::array<Vec3, 3>& corners) {
    Box box;
    for (const Vec3& p : corners) box.include(p);
    const Place low = place_of(box.low), high = place_of(box.high);
    const Vec3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    const double reach = (0.5 + 1e-6) * size_ * normal.cwiseAbs().sum();
    Place p;
    for (p[0] = low[0]; p[0] <= high[0]; ++p[0])
      for (p[1] = low[1]; p[1] <= high[1]; ++p[1])
        for (p[2] = low[2]; p[2] <= high[2]; ++p[2])
          if (std::abs(normal.dot(middle(p) - corners[0])) <= reach) kinds_[number(p)] = Kind::near;
  }

  /// What can be reached from the border without passing marked cubes is outside.
  void flood_outside() {
    std::vector<Place> reached{{0, 0, 0}};
    kinds_[0] = Kind::outside;
    while (!reached.empty()) {
      const Place from = reached.back();
      reached.pop_back();
      for (Size axis = 0; axis < 3; ++axis)
        for (const int step : {-1, 1}) {
          Place p = from;
          p[axis] += step;
          if (p[axis] < 0 || p[axis] >= counts_[axis] || kinds_[number(p)] != Kind::unknown) continue;
          kinds_[number(p)] = Kind::outside;
          reached.push_back(p);
        }
    }
  }

  /// Cubes that are not outside, and all that touch one.
  std::vector<std::uint8_t> wanted() const {
    std::vector<std::uint8_t> is_wanted(kinds_.size(), 0);
    Place p, q;
    for (p[0] = 1; p[0] + 1 < counts_[0]; ++p[0])
      for (p[1] = 1; p[1] + 1 < counts_[1]; ++p[1])
        for (p[2] = 1; p[2] + 1 < counts_[2]; ++p[2]) {
          if (kinds_[number(p)] == Kind::outside) continue;
          for (q[0] = p[0] - 1; q[0] <= p[0] + 1; ++q[0])
            for (q[1] = p[1] - 1; q[1] <= p[1] + 1; ++q[1])
              for (q[2] = p[2] - 1; q[2] <= p[2] + 1; ++q[2]) is_wanted[number(q)] = 1;
        }
    return is_wanted;
  }

  /// Cubes that are far from all marked ones join, eight to one and these again.
  void join(int most_level) {
    if (most_level == 0) return;
    levels_.assign(kinds_.size(), 0);
    const std::vector<int> depths = find_depths(least_depth(most_level));
    for (int level = most_level; level > 0; --level) {
      const int side = 1 << level;
      const PlaceRange places{{0, 0, 0},
                              {counts_[0] / side - 1, counts_[1] / side - 1, counts_[2] / side - 1}};
      places.each([&](Place p) {
        for (int& i : p) i *= side;
        const PlaceRange joined{p, {p[0] + side - 1, p[1] + side - 1, p[2] + side - 1}};
        bool may_join = levels_[number(p)] == 0;
        joined.each([&](const Place& q) { may_join = may_join && depths[number(q)] >= least_depth(level); });
        if (may_join)
          joined.each([&](const Place& q) { levels_[number(q)] = static_cast<std::uint8_t>(level); });
      });
    }
  }

  TetMesh tetrahedra(const std::vector<std::uint8_t>& is_wanted) {
    middles_.assign(kinds_.size(), -1);
    corners_.assign(kinds_.size(), -1);
    for (Size axis = 0; axis < 3; ++axis) {
      Place p;
      for (p[0] = 1; p[0] < counts_[0]; ++p[0])
        for (p[1] = 1; p[1] < counts_[1]; ++p[1])
          for (p[2] = 1; p[2] < counts_[2]; ++p[2]) {
            Place below = p;
            --below[axis];
            if (is_wanted[number(p)] || is_wanted[number(below)]) add_about_face(below, p, axis);
          }
    }
    return std::move(mesh_);
  }

  Size cube_count() const { return kinds_.size(); }

 private:
  enum class Kind : std::uint8_t { unknown, near, outside };

  Size number(const Place& p) const {
    return (static_cast<Size>(p[0]) * at(counts_[1]) + at(p[1])) * at(counts_[2]) + at(p[2]);
  }
  Vec3 corner(const Place& p) const { return origin_ + size_ * Vec3(p[0], p[1], p[2]); }
  Vec3 middle(const Place& p) const { return origin_ + size_ * Vec3(p[0] + 0.5, p[1] + 0.5, p[2] + 0.5); }
  Place place_of(const Vec3& p) const {
    Place place;
    for (int axis = 0; axis < 3; ++axis)
      place[at(axis)] = static_cast<int>(std::floor((p[axis] - origin_[axis]) / size_));
    return place;
  }

  /// Cubes from each to the nearest marked one, along edges and diagonals; `most` where there are more.
  std::vector<int> find_depths(int most) const {
    std::vector<int> depths(kinds_.size(), most);
    std::vector<Place> front, behind;
    PlaceRange{{0, 0, 0}, {counts_[0] - 1, counts_[1] - 1, counts_[2] - 1}}.each([&](const Place& p) {
      if (kinds_[number(p)] == Kind::near) front.push_back(p);
    });
    for (const Place& p : front) depths[number(p)] = 0;
    for (int depth = 1; depth < most; ++depth) {
      behind.clear();
      for (const Place& from : front) {
        PlaceRange about;
        for (Size axis = 0; axis < 3; ++axis) {
          about.first[axis] = std::max(from[axis] - 1, 0);
          about.last[axis] = std::min(from[axis] + 1, counts_[axis] - 1);
        }
        about.each([&](const Place& p) {
          if (depths[number(p)] <= depth) return;
          depths[number(p)] = depth;
          behind.push_back(p);
        });
      }
      front.swap(behind);
    }
    return depths;
  }

  int level(const Place& p) const { return levels_.empty() ? 0 : levels_[number(p)]; }
  /// The first of the cubes that have joined with this one.
  Place first_of(const Place& p) const {
    const int all_but = (1 << level(p)) - 1;
    return {p[0] & ~all_but, p[1] & ~all_but, p[2] & ~all_but};
  }

  int vertex(std::vector<int>& numbers, const Place& p, const Vec3& position) {
    int& v = numbers[number(p)];
    if (v < 0) {
      v = static_cast<int>(mesh_.positions.size());
      mesh_.positions.push_back(position);
    }
    return v;
  }
  int corner_vertex(const Place& p) { return vertex(corners_, p, corner(p)); }
  /// In the middle of a cube, or of those that have joined.
  int middle_vertex(const Place& p) {
    if (level(p) == 0) return vertex(middles_, p, middle(p));
    Place inner = first_of(p);
    for (int& i : inner) i += 1 << (level(p) - 1);
    return corner_vertex(inner);
  }

  /// Half way from one corner of a square to the next, if a smaller cube has a corner there; else -1.
  int halfway_vertex(const Place& from, const Place& to) {
    const Size along = from[0] != to[0] ? 0 : from[1] != to[1] ? 1 : 2;
    const int length = std::abs(to[along] - from[along]);
    if (length == 1) return -1;
    Place halfway = from;
    halfway[along] = std::min(from[along], to[along]);
    bool is_divided = false;
    for (const int b : {0, 1})
      for (const int c : {0, 1}) {
        Place beside = halfway;
        beside[(along + 1) % 3] -= b;
        beside[(along + 2) % 3] -= c;
        is_divided = is_divided || (1 << level(beside)) < length;
      }
    if (!is_divided) return -1;
    halfway[along] += length / 2;
    return corner_vertex(halfway);
  }

  /// What lies between the middles on the two sides of a square and the square, which has the size of the
  /// smaller cube there.
  void add_about_face(const Place& below, const Place& above, Size axis) {
    const Size b = (axis + 1) % 3, c = (axis + 2) % 3;
    const int step = 1 << std::min(level(below), level(above));
    if (first_of(below) == first_of(above) || above[b] % step != 0 || above[c] % step != 0) return;
    std::array<Place, 4> around{above, above, above, above};
    for (const Size k : {1U, 2U}) around[k][b] += step;
    for (const Size k : {2U, 3U}) around[k][c] += step;
    const int low = middle_vertex(below), high = middle_vertex(above);
    std::array<int, 4> ring;
    for (Size k = 0; k < 4; ++k) ring[k] = corner_vertex(around[k]);
    if (level(below) == level(above)) {
      for (Size k = 0; k < 4; ++k) {
        const int next = ring[(k + 1) % 4], halfway = halfway_vertex(around[k], around[(k + 1) % 4]);
        mesh_.tetrahedra.push_back({low, high, ring[k], halfway < 0 ? next : halfway});
        if (halfway >= 0) mesh_.tetrahedra.push_back({low, high, halfway, next});
      }
      return;
    }
    // Two halves, of which none has a divided edge, for all edges are the large cube's or lie on its side.
    // With the middle of that side on the diagonal angles are 45 degrees and more.
    Size first = 0;
    while (around[first][b] % (2 * step) == 0 || around[first][c] % (2 * step) == 0) ++first;
    for (const Size k : {first, (first + 2) % 4}) {
      const int p = ring[k], q = ring[(k + 1) % 4], r = ring[(k + 2) % 4];
      mesh_.tetrahedra.push_back({p, q, r, high});
      mesh_.tetrahedra.push_back({p, r, q, low});
    }
  }

  double size_;
  Vec3 origin_;
  Place counts_;
  std::vector<Kind> kinds_;
  std::vector<std::uint8_t> levels_;  // of the large cube that each has joined; empty: none has
  std::vector<int> middles_, corners_;
  TetMesh mesh_;
};

}  // namespace

core::Result<TetMesh> make_covering_lattice(const TriangleMesh& surface, double cell_size, int grading,
                                            int most) {
  Box box;
  for (const Vec3& p : surface.positions) box.include(p);
  const Vec3 extent = box.high - box.low;
  const core::Error too_many{"an element size of " + metres(cell_size) + " would make more than " +
                             std::to_string(most) + " tetrahedra; make it larger"};
  // A block of cubes is small change beside the tetrahedra, but has its limit too.
  if ((extent / cell_size + Vec3::Constant(6.0)).prod() > 30.0 * most) return too_many;
  const int most_level = std::countr_zero(static_cast<unsigned>(grading));
  CubeBlock block(box, cell_size, most_level);
  for (const Triangle& t : surface.triangles)
    block.add_triangle(
        {surface.positions[at(t[0])], surface.positions[at(t[1])], surface.positions[at(t[2])]});
  block.flood_outside();
  const std::vector<std::uint8_t> is_wanted = block.wanted();
  const auto cells = static_cast<double>(std::count(is_wanted.begin(), is_wanted.end(), 1));
  if (12.0 * cells > 1.0 * most * grading * grading * grading) return too_many;
  block.join(most_level);
  TetMesh mesh = block.tetrahedra(is_wanted);
  if (mesh.tetrahedra.size() > at(most)) return too_many;
  return mesh;
}

}  // namespace shatterbox::geometry
