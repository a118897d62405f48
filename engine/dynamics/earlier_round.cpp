#include "engine/dynamics/earlier_round.h"

#include <utility>

#include "engine/core/index.h"

namespace shatterbox::dynamics {
namespace {

using core::at;

// Solving has left where it begins as it was. A scripted one that moves may have been let go less far.
bool begins_alike(const WorkBody& x, const WorkBody& y) {
  if (x.collider != y.collider || x.is_active != y.is_active || x.inverse_mass != y.inverse_mass ||
      !is_same_pose(x.start, y.start))
    return false;
  if (!x.is_active) return true;
  return !x.is_scripted && !y.is_scripted && is_same_pose(x.predicted, y.predicted) &&
         x.velocity_start == y.velocity_start && x.spin_start == y.spin_start &&
         x.predicted_spin == y.predicted_spin;
}

}  // namespace

void match_earlier(const MotionWork& earlier, const std::vector<PairState>& states, MotionWork& work) {
  if (earlier.pairs.empty() || earlier.ids != work.ids) return;
  std::vector<char> is_alike;
  is_alike.reserve(work.bodies.size());
  for (std::size_t i = 0; i < work.bodies.size(); ++i)
    is_alike.push_back(begins_alike(earlier.bodies[i], work.bodies[i]) ? 1 : 0);
  // Those that were missed lie behind the others, and met nobody.
  const std::size_t count = earlier.pairs.size() - earlier.missed_pairs.size();
  std::size_t row = 0;
  for (WorkPair& pair : work.pairs) {
    if (!is_alike[at(pair.a)] || !is_alike[at(pair.b)] || states[at(pair.state)].is_exempt) continue;
    const std::pair key(pair.a, pair.b);
    while (row < count && std::pair(earlier.pairs[row].a, earlier.pairs[row].b) < key) ++row;
    if (row == count) return;
    if (std::pair(earlier.pairs[row].a, earlier.pairs[row].b) == key) pair.earlier = static_cast<int>(row);
  }
}

void take_over(WorkPair& earlier, WorkPair& pair) {
  pair.least_gap = earlier.least_gap;
  pair.contacts = std::move(earlier.contacts);
  pair.is_free_certified = earlier.is_free_certified;
  pair.kept_gap = earlier.kept_gap;
  pair.threshold = earlier.threshold;
  pair.is_close = earlier.is_close;
  pair.known.start_gaps = earlier.known.start_gaps;
  pair.search = pair.known.start_gaps ? pair.known.start_gaps->search : nullptr;
}

}  // namespace shatterbox::dynamics
