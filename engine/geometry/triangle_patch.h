// What one triangle means to the grids that it lies in: which nodes are near it, and how near, and which
// edges of the grid pass through it. Worked out once, in the space of the unbroken body, and kept: a piece
// has most of its triangles from its parent. [BHTF07] sec. VII; not as a minimum over triangles, for a
// piece's nearest triangle may have gone to its sibling.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <unordered_map>
#include <vector>

#include "engine/core/vec.h"

namespace shatterbox::geometry {

using GridPlace = std::array<int, 3>;  // of a node, which stands at its place times the spacing

struct TrianglePatch {
  static constexpr double kReach = 2.0;   // cells
  static constexpr int kMostCells = 240;  // of a triangle's box along any axis

  struct Node {
    std::array<std::uint8_t, 3> from_low;
    float distance;  // in cells, at most kReach
  };
  /// The edge of the grid from a node to the next one along an axis, which the triangle touches. On which
  /// side of the triangle its ends are: 1 before it, -1 behind, 0 in its plane or if the edge lies in it.
  struct Cut {
    std::array<std::uint8_t, 3> from_low;
    std::uint8_t axis;
    std::int8_t side_low, side_high;
  };

  GridPlace low{};
  std::vector<Node> nodes;
  std::vector<Cut> cuts;

  double bytes() const;
};

/// A triangle's corners in 2^-20 of a cell, so that equal triangles have equal work whoever asks first.
using GridCorners = std::array<std::array<std::int64_t, 3>, 3>;
GridCorners snap_to_grid(const std::array<Vec3, 3>& corners, double spacing);
/// Of a node from a triangle.
double distance_in_cells(const GridCorners& corners, const GridPlace& node);
/// Of a triangle of at most TrianglePatch::kMostCells. Which edges are touched is decided in whole numbers:
/// no gap between neighbours.
TrianglePatch make_patch(const GridCorners& corners);

/// The patches of a body and of all its pieces. May be asked by several threads.
class PatchCache {
 public:
  using Patches = std::vector<std::shared_ptr<const TrianglePatch>>;
  struct Figures {
    long made = 0, found = 0;
    double bytes = 0.0;  // of all that is kept
  };

  /// The patches of these triangles (|T|), those that are not known yet made and kept.
  Patches find(std::span<const GridCorners> triangles);
  Figures figures() const;

 private:
  struct KeyHash {
    std::size_t operator()(const GridCorners& corners) const;
  };

  mutable std::mutex mutex_;
  std::unordered_map<GridCorners, std::shared_ptr<const TrianglePatch>, KeyHash> kept_;  // never iterated
  Figures figures_;
};

}  // namespace shatterbox::geometry
