// The pieces that a broken body's material falls into, on the way to becoming bodies.
#pragma once

#include <optional>
#include <vector>

#include "engine/fracture/split_solid.h"
#include "engine/geometry/surface_distance.h"
#include "engine/world/fragile.h"
#include "engine/world/verdict.h"

namespace shatterbox::world {

struct Piece {
  std::shared_ptr<const Fragile> fragile;
  std::shared_ptr<const body::Shape> shape;
  bool is_held = false;  // by the support
};

struct Pieces {
  std::vector<Piece> pieces;  // largest first
  int merged_count = 0;       // too narrow to resolve, joined a neighbour
  double merged_share = 0.0;  // of the mass
};

/// What a solid's cracks that part nothing leave of it: its shape is what it was.
std::shared_ptr<const Fragile> cracked(const Fragile& whole, const fracture::SolidDecision& decision);

/// What the decision of an impact on `parent`, of that shape, left, on its way into pieces. Parent and impact
/// must outlive it.
class Splitter {
 public:
  Splitter(const Fragile& parent, std::shared_ptr<const body::Shape> shape, const EvaluatedImpact& impact);
  Splitter(const Splitter&) = delete;
  Splitter& operator=(const Splitter&) = delete;

  Pieces split();

  /// Sheets have room beside them; a solid's pieces fill it, and may be born in each other.
  bool may_clash() const { return solid_.has_value(); }

  /// From now on these pieces of the last split are not parted. False if there are none.
  bool join(const std::vector<fracture::PieceClash>& clashes);

 private:
  const Fragile& parent_;
  const std::shared_ptr<const body::Shape> shape_;
  const EvaluatedImpact& impact_;
  std::optional<fracture::SolidSplitter> solid_;
  Pieces last_;                      // what split() gave last
  geometry::TriangleMesh standing_;  // the surface of a solid that has crack faces already, material space
  std::optional<geometry::SurfaceDistance> whole_;  // of that
};

}  // namespace shatterbox::world
