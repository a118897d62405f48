#include "sandbox/script/between.h"

#include <map>

#include "engine/dynamics/free_motion.h"

namespace shatterbox::sandbox::script {

namespace {

/// Of bodies that are no more: where they would be, had they stayed with their heaviest piece.
std::map<body::BodyId, Pose> find_broken(std::span<const body::Body> before, const world::World& world) {
  std::map<body::BodyId, const body::Body*> heaviest;
  for (const body::Body& body : world.bodies()) {
    // Pieces may have broken again within the step.
    for (body::BodyId id = world.ancestry(body.id).parent; id != 0; id = world.ancestry(id).parent) {
      const body::Body*& best = heaviest[id];
      if (best == nullptr || body.shape->mass > best->shape->mass) best = &body;
    }
  }
  std::map<body::BodyId, Pose> ends;
  for (const body::Body& body : before) {
    const auto piece = heaviest.find(body.id);
    if (piece == heaviest.end()) continue;
    const body::Body& carrier = *piece->second;
    const Vec3 centre = body.shape->material_from_body - carrier.shape->material_from_body;
    ends[body.id] = {carrier.pose.rotation, carrier.pose.apply(centre)};
  }
  return ends;
}

}  // namespace

std::vector<body::Body> bodies_between(std::span<const body::Body> before, const world::World& world,
                                       double share) {
  std::vector<body::Body> bodies(before.begin(), before.end());
  const auto now = world.bodies();
  std::map<body::BodyId, Pose> broken;
  bool are_sought = false;
  for (body::Body& body : bodies) {
    Pose end = body.pose;
    if (const body::Body* after = body::find_body(now, body.id)) {
      end = after->pose;
    } else {
      if (!are_sought) broken = find_broken(before, world);
      are_sought = true;
      if (const auto found = broken.find(body.id); found != broken.end()) end = found->second;
    }
    body.pose.translation += share * (end.translation - body.pose.translation);
    const Vec3 turn = dynamics::turn_between(body.pose.rotation, end.rotation);
    body.pose.rotation = (dynamics::rotation_by(share * turn) * body.pose.rotation).normalized();
  }
  return bodies;
}

}  // namespace shatterbox::sandbox::script
