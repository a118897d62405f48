// Dents of shells: as of solids (solid_dent.h), by strains of the sheet and of its bending. What flows is
// told with every verdict; the shape, which takes a hundred times as long, of the last one alone.
#pragma once

#include <memory>

#include "engine/fracture/decide_shell.h"
#include "engine/fracture/dent.h"
#include "engine/fracture/shell_shape.h"
#include "engine/stress/shell_yield.h"

namespace shatterbox::fracture {

/// `work` is what there is for it.
struct ShellDent : DentFigures {
  ShellSubject subject;
  stress::SheetFlow flow;  // in these proportions
};

/// Where the dent leaves the shell, and by which way; without one if it cannot be seen. A `plasticity` other
/// than 1 gives it so many times the energy.
ShellShape find_dent_shape(const ShellDent& dent);

/// What an impact's linear displacement at its peak (|dof|, m and rad, of the collisions alone) means for the
/// shape.
struct ShellYieldFinding {
  double stress = 0.0;                    // Pa, von Mises, greatest
  std::shared_ptr<const ShellDent> dent;  // null: nothing flows
  bool takes_all = false;                 // flow, short of tearing, takes up all that is not given back
};

ShellYieldFinding find_yield(const ShellSubject& subject, const VecX& displacement, const DentEnergy& energy);

}  // namespace shatterbox::fracture
