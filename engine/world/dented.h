// What a dent makes of a body: its material, surface and place, and the way on which the surface gets there.
#pragma once

#include <functional>
#include <memory>

#include "engine/body/body.h"
#include "engine/fracture/solid_dent.h"
#include "engine/world/dent_room.h"
#include "engine/world/fragile.h"

namespace shatterbox::world {

/// A body as a share of a dent leaves it. The mass is what it was.
struct Dented {
  std::shared_ptr<const Fragile> fragile;
  std::shared_ptr<const body::Shape> shape;
  Pose pose;
  MovingSurface way;                                // of its surface
  std::vector<Vec3> moves;                          // |vertices of the elements|, m
  std::shared_ptr<const fracture::TornSolid> torn;  // on whose copies it is by now; null: on what it was
  double share = 0.0;                               // of the whole dent
  double volume_change = 0.0;                       // relative; of a shell that of its area
};

/// `left`: what other dents of the same hit have done to the solid.
Dented make_dented(const body::Body& body, const Fragile& whole, const fracture::SolidDent& dent,
                   const fracture::LeftDents& left, double share);
/// `moves`: |vertices of the elements|, m.
Dented make_dented(const body::Body& body, const Fragile& whole, const std::vector<Vec3>& moves,
                   double share);

/// Sets the way of a dented surface, of which `was_at` tells where a place of the material (m) was before;
/// one of the elements at it is named.
void set_way(const body::Body& body, const std::function<Vec3(int element, const Vec3& place)>& was_at,
             Dented& dented);

/// Where a body is in its new shape: a free one's centre of mass stays where it is, what is held stays in its
/// place.
Pose dented_pose(const body::Body& body, const body::Shape& shape);

}  // namespace shatterbox::world
