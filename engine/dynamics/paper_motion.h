// The contact scheme of [BHTF07] sec. III, to be compared with ours (step_motion.h): the rigid bodies are
// evolved, their surfaces' particles are given the velocities that lead to the new rigid state, cloth
// collision [BFA02] makes that motion free of crossings, its impulses are summed into each body's net linear
// and angular impulse at the step's start, and the bodies are integrated again. The particles, and not the
// rigid surfaces, are free of crossings: they drift from their bodies, and are led back to them in every
// step. No sleep, no memory but the particles.
#pragma once

#include <memory>
#include <vector>

#include "engine/body/body.h"
#include "engine/body/impulse_log.h"
#include "engine/collision/collider.h"
#include "engine/core/hash.h"
#include "engine/core/vec.h"
#include "engine/dynamics/contact_settings.h"
#include "engine/dynamics/free_motion.h"
#include "engine/dynamics/step_motion.h"

namespace shatterbox::dynamics {

/// One body's drifting surface.
struct DriftingSurface {
  body::BodyId id = 0;
  std::shared_ptr<const body::Shape> shape;
  std::shared_ptr<const collision::Collider> collider;  // of `shape`; shared between copies
  PrincipalInertia inertia;
  std::vector<double> inverse_masses;  // |V|, 1/kg: a third of each triangle's mass goes to each corner
  std::vector<Vec3> particles;         // |V| x 3, world, m
};

/// What the scheme remembers: a value, as ContactState is.
struct PaperContactState {
  std::vector<DriftingSurface> surfaces;  // ascending id
};

void add_to_hash(const PaperContactState& state, core::Hash& hash);

/// One step. In the report: `contacts` are near feature pairs, `hits` and `rounds` those of the cloth
/// collision, `failsafe_steps` bodies with particles in a rigid zone, `least_gap` between particles, and
/// `drift`.
ContactReport step_paper_motion(std::vector<body::Body>& bodies, const ContactSettings& settings,
                                PaperContactState& state, body::ImpulseLog& log);

}  // namespace shatterbox::dynamics
