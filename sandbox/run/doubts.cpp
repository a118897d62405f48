#include "sandbox/run/doubts.h"

#include "sandbox/run/doubt_groups.h"

namespace shatterbox::sandbox::run {

const scene::BodyEntry& entry_of(const scene::SceneDescription& scene, const scene::BuiltScene& built,
                                 const body::Body& body) {
  return scene.bodies[static_cast<std::size_t>(built.origins.at(body.id).entry)];
}

scene::Problems find_doubts(const scene::SceneDescription& scene, const scene::BuiltScene& built) {
  scene::Problems doubts;
  doubt_bodies(scene, built, doubts);
  doubt_places(scene, built, doubts);
  doubt_events(scene, built, doubts);
  return doubts;
}

}  // namespace shatterbox::sandbox::run
