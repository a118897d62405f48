// Dents: a body whose impact is over gets the shape that it leaves. Its surface goes straight from what it
// was to what it will be, under the promise of every motion: it meets nobody on its way, or goes as far as is
// free. The body keeps its mass and momenta; copies that shared its shape keep theirs.
#pragma once

#include <optional>

#include "engine/dynamics/contact_settings.h"
#include "engine/world/state.h"

namespace shatterbox::world {

/// A body as a dent leaves it.
struct Dented {
  std::shared_ptr<const Fragile> fragile;
  std::shared_ptr<const body::Shape> shape;
  Pose pose;
  std::vector<Vec3> moves;     // m, of the elements' vertices, as far as there was room
  double share = 0.0;          // of the whole dent
  double depth = 0.0;          // m, of the surface
  double volume_change = 0.0;  // relative
};

/// Nothing if there is no room at all, or its elements would fail.
std::optional<Dented> find_dented(const MovingState& moving, const dynamics::ContactSettings& contact,
                                  const body::Body& body, const fracture::SolidDent& dent);

/// The body with its new shape and place, of the same momenta.
body::Body as_dented(const body::Body& body, const Dented& dented);

/// Puts `dented` in the place of a body, which gets a new id.
body::BodyId put_dented(MovingState& moving, const body::Body& body, const Dented& dented,
                        std::map<body::BodyId, Ancestry>& ancestry);

DentRow describe_dent(const body::Body& body, const fracture::SolidDent& dent, const Dented* dented,
                      const Vec3& place_material, double von_mises, double yield, double time);

}  // namespace shatterbox::world
