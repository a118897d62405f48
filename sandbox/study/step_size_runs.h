// What the study of the step size plays: one bauble that falls, one ball that rests, at any step and under
// any criterion.
#pragma once

#include <vector>

#include "engine/core/vec.h"
#include "engine/world/settings.h"

namespace shatterbox::sandbox::study {

inline constexpr double kBaubleRadius = 0.04;  // m

/// How one world of the study is stepped and meshed.
struct StepCase {
  int rate = 240;  // steps a second
  world::Criterion criterion = world::Criterion::event;
  double edge = 0.0042;          // m, of the bauble's triangles
  double pane_edge = 0.025;      // m, of the pane's
  double paper_duration = 1e-3;  // s: strength times this is what the paper's criterion compares with
};

/// The paper_duration with which the paper's criterion says of the soft hit what ours says, at that step: its
/// strength is in Pa s, and nobody has measured it.
double find_paper_duration(const StepCase& how);

/// The bauble dropped from where it holds.
struct SoftHit {
  double ratio = 0.0;         // of stress to strength
  double spread = 0.0;        // the same, had the impulse been spread over the step
  Vec3 place = Vec3::Zero();  // m
  double seconds = 0.0;       // processor time
};
SoftHit play_soft_hit(const StepCase& how);

/// The bauble dropped from where it breaks, over flaw seeds, until `after` s behind the hit.
struct HardHit {
  double first_pieces = 0.0, all_pieces = 0.0, area = 0.0;  // means; m2; of penalties the first break alone
  double ratio = 0.0;                                       // of stress to strength, of the first hit, mean
  std::vector<double> masses;                               // of the first break's pieces, of all seeds, kg
  std::vector<Vec3> places;                // where its first crack began, one a seed that broke, m
  int guards = 0, bounds = 0, breaks = 0;  // breaks with an active energy guard, generation bound
  double seconds = 0.0;                    // mean
};
HardHit play_hard_hit(const StepCase& how, int seeds, double after);

/// Mean distance of the first cracks of the same seeds, m.
double distance_of_first_cracks(const HardHit& a, const HardHit& b);

/// The height (m, of the centre above touching) at which the bauble begins to break, to a percent.
struct BreakingHeight {
  double height = 0.0;
  double seconds = 0.0;
};
BreakingHeight find_breaking_height(const StepCase& how);

/// The density (kg/m3) of a ball whose weight brings the pane under it, of such triangles, to its strength.
double find_critical_density(double pane_edge);
/// Whether the pane breaks under a ball of that density within `length` s; adds to `seconds`.
bool does_break_at_rest(const StepCase& how, double density, double length, double& seconds);

}  // namespace shatterbox::sandbox::study
