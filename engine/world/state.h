// What is behind the door: the moving state, which is a value and can be put back, and what never changes.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/body/body.h"
#include "engine/body/impulse_log.h"
#include "engine/core/stop.h"
#include "engine/dynamics/paper_motion.h"
#include "engine/dynamics/step_motion.h"
#include "engine/world/acts.h"
#include "engine/world/factor_shelf.h"
#include "engine/world/forms.h"
#include "engine/world/fragile.h"
#include "engine/world/impact.h"
#include "engine/world/joints.h"
#include "engine/world/moment.h"
#include "engine/world/verdict.h"
#include "engine/world/world.h"

namespace shatterbox::world {

/// Everything a step reads and writes. Copied before a step in which something may break.
struct MovingState {
  std::vector<body::Body> bodies;  // ascending ids
  dynamics::ContactState contact;
  dynamics::PaperContactState paper_contact;      // of ContactScheme::paper
  std::map<body::BodyId, ImpactMemory> memories;  // of fragile bodies
  JointMemories joint_memories;                   // of joints that hold
  Fragiles fragiles;
  body::BodyId next_id = 1;
};

/// Pa, of the elements of what was judged, by body.
using ElementStress = std::map<body::BodyId, std::shared_ptr<const std::vector<double>>>;

/// The state at the begin of the present step, for a step that is asked to stop. Rows of the report only
/// grow.
struct StepBegin {
  std::optional<MovingState> moving;  // nothing yet: the present part's snapshot is it
  std::optional<ElementStress> element_stress;
  std::vector<dynamics::Hand> hands;
  ConservationFigures conservation;
  SolverFigures solver;
  std::vector<JointRow> joints;
  std::size_t impacts = 0, breaks = 0, dents = 0;
  long triangles_most = 0, tetrahedra_end = 0, tetrahedra_most = 0;
  double last_energy = 0.0;
  bool is_disturbed = true;
};

struct World::State {
  WorldSettings settings;
  std::vector<material::Material> materials;
  dynamics::ContactSettings contact_settings;
  std::vector<SharedForm> forms;
  std::vector<JointNature> joints;  // by number, open ones too

  MovingState moving;
  body::ImpulseLog log;                 // of the last step
  BorneImpacts borne;                   // of the last step
  std::vector<dynamics::Blast> blasts;  // of the coming step
  std::vector<dynamics::Hand> hands;    // by their numbers
  int next_hand = 1;
  std::vector<body::Way> ways;        // of the last step
  std::vector<body::Way> ended_ways;  // of this one, of bodies that broke
  std::map<body::BodyId, Ancestry> ancestry;
  ElementStress element_stress;
  WorldReport report;
  FactorShelf factors;
  core::StopQuestion wants_to_stop;  // empty: nobody asks
  Watcher watcher;                   // empty: nobody watches
  StepBegin begin;                   // of the present step
  long steps = 0;
  std::uint64_t hash = 0;
  double last_energy = 0.0;  // J
  bool is_disturbed = true;  // bodies were added, removed or pushed since the last step
};

}  // namespace shatterbox::world
