// Whether a striker goes through a body that yields, and the plug that he takes along: a prism that is wider
// than the striker by a clearance everywhere. Who decides, and cuts: solid_hole.h, shell_hole.h.
#pragma once

#include <optional>
#include <vector>

#include "engine/fracture/striker.h"
#include "engine/fracture/striker_way.h"
#include "engine/geometry/solid_punch.h"
#include "engine/material/material.h"

namespace shatterbox::fracture {

struct Perforation {
  Striker striker;
  std::vector<geometry::PunchSide> sides;  // of the plug
  double slack = 0.0;                      // m, by which corners of the plug may stand out of them
  bool is_cut = false;                     // false: he is far from going through
  double thickness = 0.0;    // m, of the material in the striker's way, along it: the mean over his section
  double plug_volume = 0.0;  // m3
  double plug_mass = 0.0;    // kg
  double wall_area = 0.0;    // m2
  double work = 0.0;         // J, of the hole
  double needed = 0.0;       // J, that the striker's motion must have for it
  double there = 0.0;        // J, that it has
  int part_count = 1;        // that the cut body falls into

  double ratio() const { return there / needed; }
  bool is_near() const { return is_cut; }
  bool is_through() const { return is_near() && there >= needed; }
  /// The momentum that the body takes from a striker who goes through, as a share of the striker's: all of it
  /// just above the limit, ever less the faster he is. [RI63]
  double momentum_share() const;
};

/// Of a body: a hole is in what is more than the hole.
inline constexpr double kMostPlug = 0.5;

/// The striker and what he has for a hole; nothing where there is no hole to speak of: what does not yield,
/// or a striker without section or speed.
std::optional<Perforation> begin_perforation(const material::Material& material, const Striker& striker);

/// What the material in his way asks of the striker. False if he is far: he has less than about a tenth of
/// the energy, or his way enters and leaves the material at a slant of more than 60 degrees so that he slides
/// off.
bool ask_for_hole(const material::Material& material, const WayMaterial& way, Perforation& perforation);

/// Books the plug that is cut, and with it what the striker needs.
void take_plug(double volume, double density, double wall_area, int part_count, Perforation& perforation);

}  // namespace shatterbox::fracture
