// How grains guide a crack through a solid. Its field tells on which side each grain lies with most of its
// nodes; the crack becomes the boundary between the grains of both sides, one nodal field as before: the
// least energy of a grain on one side less that on the other. A grain stays whole where the crack would turn
// into its weaker boundary; else the crack goes through it as it would without grains.
#pragma once

#include <vector>

#include "engine/fracture/space_grains.h"

namespace shatterbox::fracture {

/// The field of a crack that starts in `start` (an element) and whose field would be `potential` (by node; 0
/// where it is not known) if there were no grains. `weakness`: fracture energy of a boundary, share of the
/// grains' own. The grain that it starts in is not gone round.
std::vector<double> follow_grains(const SpaceGrains& grains, const geometry::TetMesh& mesh,
                                  const std::vector<double>& potential, int start, double weakness);

/// Whether a crack of that field runs along a boundary in an element: no grain has nodes on both sides.
bool is_on_boundary(const SpaceGrains& grains, const geometry::Tetrahedron& nodes,
                    const std::vector<double>& field);

}  // namespace shatterbox::fracture
