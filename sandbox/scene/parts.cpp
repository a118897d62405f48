#include "sandbox/scene/parts.h"

namespace shatterbox::sandbox::scene {

const Origin* origin_of(const BuiltScene& built, body::BodyId id) {
  const auto found = built.origins.find(built.world.ancestry(id).original);
  return found == built.origins.end() ? nullptr : &found->second;
}

std::vector<const body::Body*> parts_of(const BuiltScene& built, std::span<const body::Body> bodies,
                                        BodyRef who) {
  std::vector<const body::Body*> parts;
  for (const body::Body& body : bodies) {
    const Origin* origin = origin_of(built, body.id);
    if (origin != nullptr && who.includes(origin->entry, origin->copy)) parts.push_back(&body);
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
