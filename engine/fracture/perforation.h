// Decide, and cut: does a striker go through a solid that yields? A plug is cut out along its motion, a prism
// that is wider than the striker by a clearance everywhere and widens towards the exit: planes alone, so the
// elements do not matter, nothing binds, and what leaves has room.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "engine/fracture/striker.h"
#include "engine/geometry/solid_punch.h"
#include "engine/material/material.h"

namespace shatterbox::fracture {

struct Perforation {
  Striker striker;
  std::shared_ptr<const geometry::SolidComplex> complex;  // cut, settled; null: he is far
  std::vector<geometry::PunchSide> sides;                 // of the plug
  double thickness = 0.0;    // m, of the material in the striker's way, along it: the mean over his section
  double plug_volume = 0.0;  // m3
  double plug_mass = 0.0;    // kg
  double wall_area = 0.0;    // m2
  double work = 0.0;         // J, of the hole
  double needed = 0.0;       // J, that the striker's motion must have for it
  double there = 0.0;        // J, that it has
  int part_count = 1;        // that the cut complex falls into

  double ratio() const { return there / needed; }
  bool is_near() const { return complex != nullptr; }
  bool is_through() const { return is_near() && there >= needed; }
  /// The momentum that the body takes from a striker who goes through, as a share of the striker's: all of it
  /// just above the limit, ever less the faster he is. [RI63]
  double momentum_share() const;
};

/// Of a striker that has less than about a tenth of the energy, or whose way enters and leaves the material
/// at a slant of more than 60 degrees so that he slides off, or is open but for what is narrower than
/// `least_width` m, only that he is far is said. Nothing where the law does not tell: his plug would be more
/// than what is left, or his line parts nothing. `tag` is that of the new crack facets.
std::optional<Perforation> find_perforation(const geometry::SolidComplex& complex,
                                            const material::Material& material, const Striker& striker,
                                            double least_width, int tag);

}  // namespace shatterbox::fracture
