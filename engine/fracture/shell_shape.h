// The shape that a hit leaves a shell in, dents of any size: what is bent turns and keeps its length, what
// does not fit together stretches, and both take energy.
#pragma once

#include <vector>

#include "engine/fracture/decide_shell.h"
#include "engine/stress/shell_yield.h"

namespace shatterbox::fracture {

struct ShellShape {
  /// |vertices of the element mesh| each, m, a free shell's without rigid motion: the shapes on the way, each
  /// turned a little further; the last is that of all the energy. None: it has not moved.
  std::vector<std::vector<Vec3>> way;
  double work = 0.0;    // J, of bending and stretch
  bool is_cut = false;  // it would have torn, or turned inside out, before the energy was spent
};

/// The moves at a share of the way: of a large turn half is not half of every move.
std::vector<Vec3> moves_at(const ShellShape& shape, double share);

/// Strains in the proportions of `flow` come a little at a time, until `energy` J are spent: on what of them
/// the shell takes, and on what of it is stretched beyond the yield strength to go with that, which stays so.
/// Each time it turns by about a tenth of a radian, and its stiffness is that of the shape it has by then.
ShellShape find_shell_shape(const ShellSubject& subject, const stress::SheetFlow& flow, double energy);

}  // namespace shatterbox::fracture
