// Split: one cut solid into its connected pieces, none dropped. Flood fill over the contacts of cells.
#pragma once

#include <vector>

#include "engine/geometry/solid_complex.h"
#include "engine/geometry/solid_contacts.h"

namespace shatterbox::fracture {

/// A connected part of a solid, or all of it.
struct SolidPiece {
  geometry::SolidComplex complex;  // its material
  geometry::SolidMesh mesh;        // the same cells, with degrees of freedom of the piece's own
};

struct SolidSplit {
  std::vector<SolidPiece> pieces;  // by descending volume
  int merged_count = 0;            // pieces that joined a neighbour because nothing could resolve them
  double merged_volume = 0.0;      // m3
};

/// The pieces of a complex. Their volumes sum to its own. A piece narrower on average than `least_width` m
/// (twice its volume over its crack faces' area) is joined, before the split, to the neighbour with the
/// greatest common crack: that crack becomes a boundary that holds. So is always what has no volume at all.
/// Pieces without any neighbour stay as they are.
SolidSplit split_solid(geometry::SolidComplex complex, double least_width = 0.0);

}  // namespace shatterbox::fracture
