// Where the surface of a cut shell stands: the pieces of a piece stay within it, so that they are born inside
// what stood there before and not in the gap to its neighbours.
#pragma once

#include <array>
#include <vector>

#include "engine/core/vec.h"
#include "engine/geometry/shell_mesh.h"

namespace shatterbox::geometry {

class StandingSurface {
 public:
  /// Of the surface of `mesh`: `placed` (|V|, m, material space) is where the vertices of
  /// extract_surface(mesh, kerf) are now, whatever its kerf was.
  StandingSurface(const ShellMesh& mesh, std::vector<Vec3> placed);

  /// Number of the cell that holds a point of an element's material; -1 if the element has none.
  int cell_at(int element, const Vec2& barycentric) const;

  /// Number of the cell that holds the middle of a cell of a piece; -1 if there is none.
  int cell_of(const ShellMesh& piece, const ShellCell& cell) const;

  /// Where a point of a cell's polygon (material space, m) stands: affine in each triangle.
  Vec3 place(int cell, const Vec3& point) const;

  /// True if a point of a cell's border lies on a crack face of that number, open already.
  bool is_on_crack(int cell, int side_id, const Vec2& barycentric) const;

  /// Where the straight line from one point of a cell's polygon to another stands bent, in its order: taken
  /// from one of these to the next, it stands within `tolerance` m of straight.
  std::vector<Vec2> find_bends(int cell, const Vec2& from, const Vec2& to, double tolerance) const;

  /// True if a place in an element or beside it is on the surface as it stands, but for `tolerance` m.
  bool holds(int element, const Vec3& place, double tolerance) const;

 private:
  /// Shares of a straight line through a cell at which it goes from one triangle to the next; 0 and 1 too.
  std::vector<double> find_folds_across(int cell, const Vec3& begin, const Vec3& end) const;

  struct Fold {  // a triangle before and after
    Triangle vertices;
    std::array<Vec3, 3> corners;
  };

  const ShellMesh& mesh_;
  std::vector<Vec3> placed_;
  std::vector<std::vector<int>> element_cells_;
  std::vector<std::vector<int>> vertex_elements_;
  std::vector<std::vector<Fold>> cell_triangles_;
};

/// A piece of the whole, with its new crack faces divided where they stand bent by more than `tolerance` m:
/// so a crack has one course for what lies on both its sides, wherever their corners are.
ShellMesh divide_at_bends(const ShellMesh& piece, const StandingSurface& whole, double tolerance);

}  // namespace shatterbox::geometry
