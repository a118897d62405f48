// Worlds of a few bodies for studies with exact answers.
#pragma once

#include "engine/world/world.h"

namespace shatterbox::sandbox::study {

/// Density, friction and restitution; a name; nothing that breaks.
material::Material plain_material(double friction, double restitution);

/// Adds a material or body that cannot be refused.
int add_material(world::World& world, const material::Material& material);
body::BodyId add_body(world::World& world, const world::BodyDescription& description);

/// A box, a ball or the floor y = 0, of material number `material`.
world::BodyDescription box_description(const Vec3& half_extent, const Vec3& place, int material = 0);
world::BodyDescription ball_description(double radius, const Vec3& place, int material = 0);
world::BodyDescription floor_description(int material = 0);

/// The steps that make `seconds`.
long steps_in(const world::World& world, double seconds);
/// Takes them; returns the processor time, s.
double advance(world::World& world, double seconds);

}  // namespace shatterbox::sandbox::study
