// The parts of a cracked shell that a load is on. Nothing moves elsewhere: pieces that came off without a
// load need no factor.
#pragma once

#include <vector>

#include "engine/core/disjoint_sets.h"
#include "engine/core/vec.h"
#include "engine/geometry/shell_mesh.h"

namespace shatterbox::stress {

/// The virtual vertices, joined where a cell holds both: a set a connected part.
core::DisjointSets parts_of(const geometry::ShellMesh& mesh);

/// The connected part of each unknown (|dof|), numbered from 0 by its first vertex; -1 for unknowns in no
/// cell.
std::vector<int> part_of_dofs(const geometry::ShellMesh& mesh);

/// The mesh without the cells of connected parts on which none of `loads` (|dof| each) is. Its degrees of
/// freedom are the mesh's own; those of parts left out are in no cell, so a solution is zero there.
geometry::ShellMesh loaded_parts(const geometry::ShellMesh& mesh, const std::vector<const VecX*>& loads);

}  // namespace shatterbox::stress
