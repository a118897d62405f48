#include "sandbox/scene/parts.h"

namespace shatterbox::sandbox::scene {

std::vector<const body::Body*> parts_of(const BuiltScene& built, std::span<const body::Body> bodies,
                                        BodyRef who) {
  std::vector<const body::Body*> parts;
  for (const body::Body& body : bodies) {
    const auto original = built.origins.find(built.world.ancestry(body.id).original);
    if (original != built.origins.end() && who.includes(original->second.entry, original->second.copy))
      parts.push_back(&body);
  }
  return parts;
}

std::optional<Vec3> centre_of(const BuiltScene& built, std::span<const body::Body> bodies, BodyRef who) {
  double mass = 0.0;
  Vec3 moment = Vec3::Zero();
  std::optional<Vec3> massless;
  for (const body::Body* body : parts_of(built, bodies, who)) {
    mass += body->shape->mass;
    moment += body->shape->mass * body->pose.translation;
    if (!massless) massless = body->pose.translation;
  }
  if (mass <= 0.0) return massless;
  return Vec3(moment / mass);
}

Vec3 velocity_of(const BuiltScene& built, std::span<const body::Body> bodies, BodyRef who) {
  double mass = 0.0;
  Vec3 momentum = Vec3::Zero();
  for (const body::Body* body : parts_of(built, bodies, who)) {
    mass += body->shape->mass;
    momentum += body->shape->mass * body->velocity;
  }
  return mass > 0.0 ? Vec3(momentum / mass) : Vec3(Vec3::Zero());
}

}  // namespace shatterbox::sandbox::scene
