// What dents of solids and of shells have in common.
#pragma once

namespace shatterbox::fracture {

/// What an impact brings for a dent.
struct DentEnergy {
  double all = 0.0;   // J: what of it the linear stress at its peak does not hold (it is in the contact, and
                      // in motion that is still to be stopped) flows in the same share, where the rest does
  double most = 0.0;  // J, that is not given back; there is no more flow than that
};

struct DentFigures {
  double work = 0.0;       // J, of plastic flow
  double flowed = 0.0;     // m3
  double torn_area = 0.0;  // m2, of the tears that it opens (one face)
  bool is_cut = false;     // elements would have been crushed or torn by all of it, or all have swollen
};

}  // namespace shatterbox::fracture
