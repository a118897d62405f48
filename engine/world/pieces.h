// The pieces that a broken body's material falls into, on the way to becoming bodies.
#pragma once

#include <vector>

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

/// Splits what the decision of an impact on `parent`, of that shape, left.
Pieces make_pieces(const Fragile& parent, const body::Shape& shape, const EvaluatedImpact& impact);

}  // namespace shatterbox::world
