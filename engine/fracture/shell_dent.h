// Dents of shells: as of solids (solid_dent.h), by strains of the sheet and of its bending.
#pragma once

#include <memory>
#include <vector>

#include "engine/fracture/decide_shell.h"
#include "engine/fracture/dent.h"

namespace shatterbox::fracture {

struct ShellDent : DentFigures {
  std::vector<Vec3> moves;  // |vertices of the element mesh|, m: where it leaves them
};

/// What an impact's linear displacement at its peak (|dof|, m and rad, of the collisions alone) means for the
/// shape.
struct ShellYieldFinding {
  double stress = 0.0;                    // Pa, von Mises, greatest
  std::shared_ptr<const ShellDent> dent;  // null: nothing flows, or its shape cannot be told
};

ShellYieldFinding find_yield(const ShellSubject& subject, const VecX& displacement, const DentEnergy& energy);

}  // namespace shatterbox::fracture
