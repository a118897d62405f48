#include "engine/geometry/tet_lattice.h"

#include <algorithm>
#include <array>
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

/// A block of cubes about a surface, with two cubes more on each side.
class CubeBlock {
 public:
  CubeBlock(const Box& box, double cell_size) : size_(cell_size) {
    for (int axis = 0; axis < 3; ++axis) {
      const double extent = box.high[axis] - box.low[axis];
      counts_[at(axis)] = static_cast<int>(std::ceil(extent / size_)) + 5;
      // About the middle, off it by different parts of a cell: what is round numbers there is none here, and
      // planes of symmetry are none of the lattice's.
      const double shift = std::array{0.1180339887, 0.0902113033, 0.1543689012}[at(axis)];
      origin_[axis] = 0.5 * (box.low[axis] + box.high[axis]) - (0.5 * counts_[at(axis)] + shift) * size_;
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

  int vertex(std::vector<int>& numbers, const Place& p, const Vec3& position) {
    int& v = numbers[number(p)];
    if (v < 0) {
      v = static_cast<int>(mesh_.positions.size());
      mesh_.positions.push_back(position);
    }
    return v;
  }

  /// The middles on the two sides of a cube's face, with each of its four edges.
  void add_about_face(const Place& below, const Place& above, Size axis) {
    const Size b = (axis + 1) % 3, c = (axis + 2) % 3;
    std::array<Place, 4> around{above, above, above, above};
    for (const Size k : {1U, 2U}) ++around[k][b];
    for (const Size k : {2U, 3U}) ++around[k][c];
    const int low = vertex(middles_, below, middle(below)), high = vertex(middles_, above, middle(above));
    std::array<int, 4> ring;
    for (Size k = 0; k < 4; ++k) ring[k] = vertex(corners_, around[k], corner(around[k]));
    for (Size k = 0; k < 4; ++k) mesh_.tetrahedra.push_back({low, high, ring[k], ring[(k + 1) % 4]});
  }

  double size_;
  Vec3 origin_;
  Place counts_;
  std::vector<Kind> kinds_;
  std::vector<int> middles_, corners_;
  TetMesh mesh_;
};

}  // namespace

core::Result<TetMesh> make_covering_lattice(const TriangleMesh& surface, double cell_size, int most) {
  Box box;
  for (const Vec3& p : surface.positions) box.include(p);
  const Vec3 extent = box.high - box.low;
  const core::Error too_many{"an element size of " + metres(cell_size) + " would make more than " +
                             std::to_string(most) + " tetrahedra; make it larger"};
  // A block of cubes is small change beside the tetrahedra, but has its limit too.
  if ((extent / cell_size + Vec3::Constant(6.0)).prod() > 30.0 * most) return too_many;
  CubeBlock block(box, cell_size);
  for (const Triangle& t : surface.triangles)
    block.add_triangle(
        {surface.positions[at(t[0])], surface.positions[at(t[1])], surface.positions[at(t[2])]});
  block.flood_outside();
  const std::vector<std::uint8_t> is_wanted = block.wanted();
  if (12.0 * static_cast<double>(std::count(is_wanted.begin(), is_wanted.end(), 1)) > most) return too_many;
  return block.tetrahedra(is_wanted);
}

}  // namespace shatterbox::geometry
