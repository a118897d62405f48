// Who strikes, as what it strikes through sees of it: a rigid stamp of one section that moves along a line.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/core/vec.h"

namespace shatterbox::fracture {

/// In the material space of the body that is struck, at that moment.
struct Striker {
  std::uint32_t number = 0;                            // whose: for the caller
  Vec3 direction = Vec3::UnitZ();                      // of its motion against the struck body, unit
  Vec3 centre = Vec3::Zero();                          // m, on the line along which its centre of mass moves
  Vec3 place = Vec3::Zero();                           // m, where it touched
  double speed = 0.0;                                  // m/s, along the direction
  double mass = 0.0;                                   // kg
  double struck_inverse_mass = 0.0;                    // 1/kg, of the struck body on that line; 0: it is held
  double time = 0.0;                                   // s, since the step began
  Vec3 first = Vec3::UnitX(), second = Vec3::UnitY();  // unit, across the direction; right-handed with it
  /// The section across the motion: all within `radius` of the convex polygon (counter-clockwise, m, from the
  /// centre along `first` and `second`); one corner: a disc.
  std::vector<Vec2> core;
  double radius = 0.0;    // m
  double flatness = 0.0;  // 0: round or pointed in front, 1: flat and square
};

/// Section across the motion.
struct StrikerSection {
  double area = 0.0;       // m2
  double perimeter = 0.0;  // m
  double diameter = 0.0;   // m, of the disc of that area
};
StrikerSection section_of(const Striker& striker);

/// Who of the loads' strikers brings most; null: nobody strikes. Of presses, each with a load.
template <class Presses>
const Striker* hardest_striker(const Presses& presses) {
  const Striker* hardest = nullptr;
  for (const auto& press : presses) {
    const Striker* striker = press.load->striker.get();
    if (striker && (!hardest || striker->mass * striker->speed * striker->speed >
                                    hardest->mass * hardest->speed * hardest->speed))
      hardest = striker;
  }
  return hardest;
}

/// Corners of the convex hull, counter-clockwise from the one farthest left; those on a straight line left
/// out.
std::vector<Vec2> convex_hull(std::vector<Vec2> points);

}  // namespace shatterbox::fracture
