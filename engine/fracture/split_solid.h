// Split: one cut solid into its connected pieces, none dropped. Flood fill over the contacts of cells.
#pragma once

#include <map>
#include <set>
#include <utility>
#include <vector>

#include "engine/geometry/solid_complex.h"
#include "engine/geometry/solid_contacts.h"

namespace shatterbox::fracture {

/// A connected part of a solid, or all of it.
struct SolidPiece {
  geometry::SolidComplex complex;  // its material
  geometry::SolidMesh mesh;        // the same cells, with degrees of freedom of the piece's own
  int before = -1;  // its number in the split before, if there was one and it is as it was: then it is empty
};

struct SolidSplit {
  std::vector<SolidPiece> pieces;  // by descending volume
  int merged_count = 0;            // pieces that joined a neighbour because nothing could resolve them
  double merged_volume = 0.0;      // m3, of them; material that was joined time and again counts once
};

/// A piece of a split that cannot be as it is, by its number: what it would be born in, another piece or, if
/// `b` is below zero, none of them.
struct PieceClash {
  int a = 0, b = -1;
};

/// A cut solid on its way into pieces. Their volumes sum to its own. A piece narrower on average than
/// `least_width` m (twice its volume over its crack faces' area) is joined, before the split, to the
/// neighbour with the greatest common crack: that crack becomes a boundary that holds. So is always what has
/// no volume at all. Pieces without any neighbour stay as they are.
class SolidSplitter {
 public:
  explicit SolidSplitter(geometry::SolidComplex complex, double least_width = 0.0);

  /// The pieces; of what the last call gave already, and nothing has joined since, only which it was.
  SolidSplit split();

  /// From now on pieces of the last split that clash are one; where no crack is between them, the smaller one
  /// and its neighbour with the greatest common crack. False if nothing could be joined.
  bool join(const std::vector<PieceClash>& clashes);

 private:
  void label();
  std::map<std::pair<int, int>, double> find_common_areas() const;
  bool join_narrow(double least_width);
  bool unite(const std::set<std::pair<int, int>>& pairs);

  geometry::SolidComplex complex_;
  std::vector<geometry::SolidContact> contacts_;
  std::vector<int> piece_of_;    // per cell
  std::vector<int> last_split_;  // per cell: its piece then; empty: there was none
  std::vector<double> volumes_;  // per piece, m3, descending
  int merged_count_ = 0;
  std::vector<char> was_merged_;  // per cell; empty: none
};

/// The pieces of a complex, none of which clash.
SolidSplit split_solid(geometry::SolidComplex complex, double least_width = 0.0);

}  // namespace shatterbox::fracture
