#include "sandbox/study/contact_scene.h"

#include "sandbox/study/stopwatch.h"

namespace shatterbox::sandbox::study {

ContactScene::ContactScene(const world::World& world, double time_step, int substeps) {
  bodies.assign(world.bodies().begin(), world.bodies().end());
  settings.time_step = time_step;
  settings.gravity = world.settings().gravity;
  settings.substeps = substeps;
  settings.has_sleep = false;
}

void ContactScene::step() {
  const Vec3 before = momentum();
  log.clear();
  const Stopwatch watch;
  dynamics::wake_bodies(bodies, settings, state_);
  report = dynamics::step_motion(bodies, settings, state_, log);
  dynamics::put_to_sleep(bodies, settings, state_);
  seconds += watch.seconds();
  Vec3 explained = mass() * settings.time_step * settings.gravity;
  const auto moves = [&](body::BodyId id) {  // the failsafe's impulses have one body
    const body::Body* found = body::find_body(bodies, id);
    return found != nullptr && found->is_dynamic();
  };
  for (const body::LoggedImpulse& entry : log) {
    if (moves(entry.body_a)) explained += entry.impulse_world;
    if (moves(entry.body_b)) explained -= entry.impulse_world;
  }
  unexplained_ = (momentum() - before - explained).norm();
}

double ContactScene::kinetic_energy() const {
  double sum = 0.0;
  for (const body::Body& body : bodies) sum += body::kinetic_energy(body);
  return sum;
}

double ContactScene::energy() const {
  double sum = kinetic_energy();
  for (const body::Body& body : bodies)
    if (body.is_dynamic()) sum -= body.shape->mass * settings.gravity.dot(body.pose.translation);
  return sum;
}

double ContactScene::mass() const {
  double sum = 0.0;
  for (const body::Body& body : bodies)
    if (body.is_dynamic()) sum += body.shape->mass;
  return sum;
}

Vec3 ContactScene::momentum() const {
  Vec3 sum = Vec3::Zero();
  for (const body::Body& body : bodies)
    if (body.is_dynamic()) sum += body.shape->mass * body.velocity;
  return sum;
}

}  // namespace shatterbox::sandbox::study
