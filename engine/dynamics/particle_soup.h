// Cloth collision [BFA02] on a soup of triangles whose particles move on their own: repulsions between what
// is near, impulses at what the straight paths would cross, and at last zones of particles that move as one
// rigid body. Serves the scheme of [BHTF07] sec. III (paper_motion.h).
#pragma once

#include <vector>

#include "engine/collision/collider.h"
#include "engine/collision/feature_list.h"
#include "engine/core/vec.h"

namespace shatterbox::dynamics {

/// The particles of one body.
struct SoupBody {
  const collision::Collider* collider = nullptr;
  std::vector<Vec3> positions;         // |V| x 3, m, at the step's start; no surface crosses another
  std::vector<Vec3> velocities;        // |V| x 3, m/s, wanted; changed so that no straight path crosses
  std::vector<double> inverse_masses;  // |V|, 1/kg; 0 for a particle that nothing moves
};

struct SoupPair {
  int a = 0, b = 0;        // numbers of the bodies
  double thickness = 0.0;  // m: closer surfaces repel
  double friction = 0.0;
};

/// One impulse between two bodies.
struct SoupImpulse {
  int pair = 0;
  Vec3 point = Vec3::Zero();    // m, world, at the step's start
  Vec3 normal = Vec3::Zero();   // unit, from b towards a
  Vec3 impulse = Vec3::Zero();  // N s, on a
  double closing_speed = 0.0;   // m/s, of the particles before it
};

struct SoupReport {
  int near_features = 0;     // that repelled
  int rounds = 0;            // in which paths crossed and impulses were given
  int hits = 0;              // crossing feature paths, summed over the rounds
  std::vector<char> zoned;   // per body: some of its particles ended in a rigid zone
  double least_gap = 1e300;  // m, of near features at the start
};

/// Changes the velocities of the bodies' particles until no surface crosses another on the straight paths of
/// `time_step` seconds. Lists every impulse in `impulses`, those of zones excepted.
SoupReport collide_soup(double time_step, const std::vector<SoupPair>& pairs, std::vector<SoupBody>& bodies,
                        std::vector<SoupImpulse>& impulses);

}  // namespace shatterbox::dynamics
