#include "engine/geometry/box_tets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "engine/core/index.h"
#include "engine/geometry/generator_faults.h"

namespace shatterbox::geometry {
namespace {

using core::at;
using Place = std::array<int, 3>;

constexpr double kFlattest = 2.0;  // greatest ratio of a cell's sides, but for rounding to whole cells

/// A box of cells: their corners first, then their middles, then the middles of the faces on the border.
class CellBox {
 public:
  CellBox(const Vec3& half_extent, const Place& cells) : half_extent_(half_extent), cells_(cells) {
    // Places count half cells: corners are even, middles odd.
    add_vertices({0, 0, 0}, {2, 2, 2});
    first_middle_ = static_cast<int>(mesh_.positions.size());
    add_vertices({1, 1, 1}, {2, 2, 2});
    for (int axis = 0; axis < 3; ++axis) {
      Place first{1, 1, 1}, step{2, 2, 2};
      first[at(axis)] = 0;
      step[at(axis)] = 2 * cells_[at(axis)];
      first_border_[at(axis)] = static_cast<int>(mesh_.positions.size());
      add_vertices(first, step);
    }
    for (int axis = 0; axis < 3; ++axis) add_tetrahedra(axis);
  }

  TetMesh take() { return std::move(mesh_); }

 private:
  void add_vertices(const Place& first, const Place& step) {
    for (int x = first[0]; x <= 2 * cells_[0]; x += step[0])
      for (int y = first[1]; y <= 2 * cells_[1]; y += step[1])
        for (int z = first[2]; z <= 2 * cells_[2]; z += step[2])
          mesh_.positions.emplace_back(coordinate(0, x), coordinate(1, y), coordinate(2, z));
  }

  /// From minus the half extent to plus it, both to the bit, and odd about the middle.
  double coordinate(int axis, int place) const {
    const int n = cells_[at(axis)];
    return half_extent_[axis] * (static_cast<double>(place - n) / n);
  }

  int corner(const Place& p) const { return (p[0] * (cells_[1] + 1) + p[1]) * (cells_[2] + 1) + p[2]; }

  /// The middle of cell `p`, or of the face of the border that is in its place, beyond which it lies.
  int middle(const Place& p, int axis) const {
    const int n = cells_[at(axis)];
    if (p[at(axis)] >= 0 && p[at(axis)] < n)
      return first_middle_ + (p[0] * cells_[1] + p[1]) * cells_[2] + p[2];
    Place face = p, counts = cells_;
    face[at(axis)] = p[at(axis)] < 0 ? 0 : 1;
    counts[at(axis)] = 2;
    return first_border_[at(axis)] + (face[0] * counts[1] + face[1]) * counts[2] + face[2];
  }

  /// About each face across `axis`: the middles on its two sides with each of its four edges.
  void add_tetrahedra(int axis) {
    const auto a = at(axis), b = (a + 1) % 3, c = (a + 2) % 3;
    Place end = cells_;
    ++end[a];
    Place p;
    for (p[0] = 0; p[0] < end[0]; ++p[0])
      for (p[1] = 0; p[1] < end[1]; ++p[1])
        for (p[2] = 0; p[2] < end[2]; ++p[2]) {
          std::array<Place, 4> around{p, p, p, p};  // counter-clockwise seen from the greater side
          for (const std::size_t k : {1U, 2U}) ++around[k][b];
          for (const std::size_t k : {2U, 3U}) ++around[k][c];
          Place below = p;
          --below[a];
          const int low = middle(below, axis), high = middle(p, axis);
          for (std::size_t k = 0; k < 4; ++k)
            mesh_.tetrahedra.push_back({low, high, corner(around[k]), corner(around[(k + 1) % 4])});
        }
  }

  Vec3 half_extent_;
  Place cells_;
  int first_middle_ = 0;
  Place first_border_{};  // per axis: the middles of the faces at its least end, then at its greatest
  TetMesh mesh_;
};

}  // namespace

core::Result<TetMesh> make_box_tets(const Vec3& half_extent, double element_size) {
  for (int axis = 0; axis < 3; ++axis)
    if (const auto fault = find_size_fault("a box' half extent", half_extent[axis]))
      return core::Error{*fault};
  if (const auto fault = find_size_fault("the element size", element_size)) return core::Error{*fault};
  const double size = std::min(element_size, kFlattest * 2.0 * half_extent.minCoeff());
  Place cells;
  double count = 12.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double wanted = std::max(1.0, std::floor(2.0 * half_extent[axis] / size + 0.5));
    count *= wanted;
    if (count > kMostTetrahedra)
      return core::Error{"an element size of " + metres(size) + " would make more than " +
                         std::to_string(kMostTetrahedra) + " tetrahedra of this box; make it larger"};
    cells[at(axis)] = static_cast<int>(wanted);
  }
  return CellBox(half_extent, cells).take();
}

}  // namespace shatterbox::geometry
