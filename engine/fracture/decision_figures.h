// What every verdict says in figures, whatever the body that was judged.
#pragma once

#include <vector>

#include "engine/fracture/impact.h"

namespace shatterbox::fracture {

struct DecisionFigures {
  Verdict verdict;
  std::vector<double>
      element_stress;  // |T| of the element mesh: greatest principal stress at the peak, first solve, Pa
  int cracks = 0;
  int core_cells = 0;            // crushed, about hits
  double new_area = 0.0;         // m2, of the cracks (one face)
  double grain_area = 0.0;       // m2 of it, along grain boundaries
  double fracture_energy = 0.0;  // J, used
  double elastic_energy = 0.0;   // J, there to be used, or given by loads; 0 unless the body is overloaded
  int generations = 0;           // solves
  int factorisations = 0;
  double residual = 0.0;  // worst relative residual of the solves
  bool energy_guard_active = false;
  bool generation_bound_active = false;   // cracks still grew when the generations were spent
  double solve_ms = 0.0, trace_ms = 0.0;  // wall time; enters no state

  /// A bound showed that it holds.
  bool needed_no_solve() const { return generations == 0 && verdict.outcome == Outcome::held; }
};

}  // namespace shatterbox::fracture
