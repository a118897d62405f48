// Cut: a shell's cells while cracks run through them. A chord divides one convex cell into two; whatever is
// cut, the cells stay convex and their areas sum to what they were.
#pragma once

#include <optional>
#include <vector>

#include "engine/core/vec.h"
#include "engine/geometry/shell_mesh.h"

namespace shatterbox::fracture {

/// A cell while it is being cut.
struct CutCell {
  int element = 0;
  int origin = 0;  // cell of the mesh that the cutter was made from
  int grain = -1;
  std::vector<geometry::ShellCorner> polygon;  // convex, counter-clockwise
};

/// A point on the border of a cell.
struct BorderPlace {
  int side = 0;  // number of the polygon's side, or of its corner
  bool is_corner = false;
  Vec2 barycentric = Vec2::Zero();
};

/// A side of a cell on an element's edge.
struct EdgeStretch {
  int cell = 0, side = 0;
  double begin = 0.0, end = 1.0;  // parameters along the edge, begin < end
};

class ShellCutter {
 public:
  explicit ShellCutter(const geometry::ShellMesh& mesh);

  const geometry::ShellElements& elements() const { return *elements_; }
  int cell_count() const { return static_cast<int>(cells_.size()); }
  const CutCell& cell(int number) const { return cells_[static_cast<std::size_t>(number)]; }
  const std::vector<int>& cells_of(int element) const {
    return of_element_[static_cast<std::size_t>(element)];
  }

  /// Divides a cell along the chord from `a` to `b`; both new sides get the kind and number. The cell keeps
  /// what is left of a -> b. False, and nothing has changed, if one part would be below 1e-6 of the element's
  /// area.
  bool cut(int cell, const BorderPlace& a, const BorderPlace& b, geometry::SideKind kind, int side_id);

  /// Puts `parts` (convex, together the cell) in the cell's place.
  void replace(int cell, std::vector<std::vector<geometry::ShellCorner>> parts);

  /// The element's cell with a stretch of `edge` that has `parameter` strictly inside; nothing where a cut
  /// ends there already, or where this piece has no material.
  std::optional<EdgeStretch> find_stretch(int element, int edge, double parameter) const;

  /// Where cuts reach an edge, ascending, without its ends.
  std::vector<double> breaks_of_edge(int edge) const;

  /// The cell that holds a point of an element, -1 if none does.
  int find_cell(int element, const Vec2& barycentric) const;

  /// The stretch of one side; `cell`'s side must be on an element's edge.
  EdgeStretch stretch(int cell, int side) const;

  /// A number that no side has yet.
  int new_side_id() { return next_side_id_++; }

  /// The cut mesh, its cells by element, with its degrees of freedom; and which of its cells touch, if asked
  /// for.
  geometry::ShellMesh mesh(std::vector<geometry::CellContact>* contacts = nullptr) const;

 private:
  std::shared_ptr<const geometry::ShellElements> elements_;
  std::vector<CutCell> cells_;
  std::vector<std::vector<int>> of_element_;
  int next_side_id_ = 0;
};

/// Twice the area of a convex polygon in barycentric weights: its share of the element's area.
double polygon_fraction(const std::vector<geometry::ShellCorner>& polygon);

}  // namespace shatterbox::fracture
