// Split: one cut mesh into its connected pieces, none dropped. Flood fill over the contacts of cells.
#pragma once

#include <cstddef>
#include <vector>

#include "engine/geometry/shell_mesh.h"
#include "engine/geometry/standing_surface.h"

namespace shatterbox::fracture {

struct SplitSettings {
  double least_width =
      0.0;  // m: pieces narrower than this on average (2 area / perimeter) join their neighbour
  /// What was there before its newest cracks: those it had stay open, for its surface stands back from them
  /// already. Null: all cracks are new.
  const geometry::StandingSurface* whole = nullptr;
};

struct ShellSplit {
  std::vector<geometry::ShellMesh> pieces;  // by descending area; degrees of freedom are the piece's own
  int merged_count = 0;      // pieces that joined a neighbour because nothing could resolve them
  double merged_area = 0.0;  // m2, of them; material that was joined time and again counts once
};

/// Flood fill: the number of the piece of each cell, numbered by their first cells.
std::vector<int> label_pieces(std::size_t cell_count, const std::vector<geometry::CellContact>& contacts,
                              int& piece_count);

/// The pieces of a mesh. Their areas sum to the mesh's. A piece below the least width is joined, before the
/// split, to the neighbour with the longest common new crack: that crack becomes closed material again.
/// Pieces without any such neighbour stay as they are.
ShellSplit split_shell(const geometry::ShellMesh& mesh, const SplitSettings& settings = {});
/// The same, of a mesh whose contacts (find_cell_contacts) are known.
ShellSplit split_shell(const geometry::ShellMesh& mesh, std::vector<geometry::CellContact> contacts,
                       const SplitSettings& settings);

}  // namespace shatterbox::fracture
