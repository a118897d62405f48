// What a run is given once, before its first step.
#pragma once

#include <cstdint>
#include <optional>

#include "engine/core/vec.h"

namespace shatterbox::world {

/// How the verdict on an impact is reached (DESIGN: time-averaged stress).
enum class Criterion : std::uint8_t {
  event,    // sums over an impact event, divided by the impact's own duration: Pa, independent of the step
  paper,    // [BHTF07] sec. VI: all impulses of one step together, compared in Pa s
  penalty,  // for comparison, [BHTF07] figs. 9, 10: a snapshot of the force of a spring against overlap
};

/// What happens to the bodies that met a body that broke.
enum class AfterBreak : std::uint8_t {
  go_back,  // the step is taken again with the pieces in place of the whole: a projectile keeps its momentum
  inherit,  // [BHTF07] sec. VII: pieces inherit the parent's velocity after the collision
};

/// How bodies are kept apart.
enum class ContactScheme : std::uint8_t {
  standard,  // engine/dynamics/step_motion.h
  paper,  // [BHTF07] sec. III: cloth collision on a surface that drifts from its rigid body; for comparison
};

struct WorldSettings {
  int steps_per_second = 240;            // usually 120 to 960
  Vec3 gravity = Vec3(0.0, -9.81, 0.0);  // m/s2
  std::uint64_t seed = 1;                // flaws and grains
  Criterion criterion = Criterion::event;
  AfterBreak after_break = AfterBreak::go_back;
  ContactScheme contact = ContactScheme::standard;
  std::optional<double> stress_window;  // s; the duration of every impact, where it is not to be computed
  double paper_duration = 1e-3;  // s; Criterion::paper compares the stress integral with strength times this
  int crack_generations = 3;     // solves of one cracking shell: radial cracks, rings, and what they leave
  int piece_generations = 2;     // the same of a shell that is itself a piece; solids have six
  bool has_energy_guard = true;  // cracks use no more energy than there is; off: to see what that changes
  bool has_sleep = true;         // islands at rest fall asleep and cost nothing
  int substeps = 8;              // of a step, of bodies in contact
  double solve_residual = 2e-3;  // that solves of solids' stress go down to, relative
  int most_generations = 4;      // how often the pieces of one impact event may break again, usually 2 to 4
};

}  // namespace shatterbox::world
