// Bodies under the stages of motion alone, so that the iterations of contact can be set; and what goes wrong
// in a run.
#pragma once

#include <vector>

#include "engine/dynamics/step_motion.h"
#include "engine/world/world.h"

namespace shatterbox::sandbox::study {

class ContactScene {
 public:
  /// The bodies of a world, from where they are.
  ContactScene(const world::World& world, double time_step, int substeps);

  /// One step, as the world takes it.
  void step();

  double kinetic_energy() const;  // J
  double energy() const;          // J, with that of gravity
  /// kg m/s: what the last step's impulses and gravity do not explain of its change of momentum.
  double unexplained_momentum() const { return unexplained_; }
  double mass() const;  // kg, of all that can move

  std::vector<body::Body> bodies;
  dynamics::ContactSettings settings;
  body::ImpulseLog log;            // of the last step
  dynamics::ContactReport report;  // of the last step
  double seconds = 0.0;            // processor time of all steps

 private:
  Vec3 momentum() const;

  dynamics::ContactState state_;
  double unexplained_ = 0.0;
};

}  // namespace shatterbox::sandbox::study
