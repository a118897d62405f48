// Where a crack leaves a cell: on an element's edge, where it may go on, or on another cut, where it ends.
#pragma once

#include <optional>
#include <vector>

#include "engine/fracture/element_plane.h"
#include "engine/fracture/shell_cutter.h"

namespace shatterbox::fracture {

struct CrackExit {
  BorderPlace place;
  bool is_on_edge = false;  // of the element; the crack may go on behind it
  bool has_met_cut = false;
  int edge = -1;
  double parameter = 0.0;  // along the edge, from its lower-numbered vertex
};

/// Cuts that come nearer to each other than a share of the thickness become one; none passes a vertex. All
/// that it is given must outlive it.
class ExitFinder {
 public:
  ExitFinder(const ShellCutter& cutter, const ElementPlanes& planes, double thickness);

  /// Where a straight line from `start` (plane coordinates) leaves the cell, other than by `entry_side` (-1:
  /// it starts inside).
  std::optional<CrackExit> find_exit(int cell, int entry_side, const Vec2& start, const Vec2& heading) const;
  /// The exit on a side that lies on an element's edge, at or near `parameter` of the edge.
  CrackExit settle_on_edge(int cell, int side, double parameter) const;

 private:
  CrackExit settle_on_cut(int cell, int side, double share) const;
  double join_share(double length) const;

  const ShellCutter& cutter_;
  const ElementPlanes& planes_;
  const geometry::ShellElements& elements_;
  double thickness_;  // m
};

}  // namespace shatterbox::fracture
