#include "engine/dynamics/part_memory.h"

#include <utility>

#include "engine/core/index.h"
#include "engine/dynamics/contact_state.h"
#include "engine/dynamics/motion_work.h"

namespace shatterbox::dynamics {
namespace {

using core::at;

PartMemory::Begin begin_of(body::BodyId id, const WorkBody& w) {
  return {id,     w.collider,       w.start,      w.predicted,    w.velocity,
          w.spin, w.predicted_spin, w.turn_angle, w.inverse_mass, w.is_active};
}

// Per body: whether it begins as it did.
std::vector<char> find_unchanged(const PartMemory& former, const PartMemory& memory) {
  std::vector<char> is_unchanged(memory.bodies.size(), 0);
  std::size_t row = 0;
  for (std::size_t i = 0; i < memory.bodies.size(); ++i) {
    while (row < former.bodies.size() && former.bodies[row].id < memory.bodies[i].id) ++row;
    is_unchanged[i] = row < former.bodies.size() && former.bodies[row] == memory.bodies[i] ? 1 : 0;
  }
  return is_unchanged;
}

PartMemory::Pair row_of(const PairState& state, const WorkPair& pair, const PartMemory& earlier) {
  PartMemory::Pair row;
  row.body_a = state.body_a;
  row.body_b = state.body_b;
  if (pair.earlier >= 0)
    row.before = earlier.pairs[at(pair.earlier)].before;
  else
    row.before = {state.kept_gap,  !pair.is_first_seen, state.is_touching,
                  state.is_exempt, state.trouble_age,   state.contacts.size()};
  return row;
}

}  // namespace

bool WayEnd::is_of(const WorkBody& body) const {
  if (straight_parts != body.straight_parts || knots.size() != body.knots.size() ||
      !is_same_pose(end, body.end))
    return false;
  for (std::size_t k = 0; k < knots.size(); ++k)
    if (!is_same_pose(knots[k], body.knots[k])) return false;
  return true;
}

bool PartMemory::Begin::operator==(const Begin& other) const {
  return id == other.id && collider == other.collider && is_same_pose(start, other.start) &&
         is_same_pose(predicted, other.predicted) && velocity == other.velocity && spin == other.spin &&
         predicted_spin == other.predicted_spin && turn_angle == other.turn_angle &&
         inverse_mass == other.inverse_mass && is_active == other.is_active;
}

void begin_part(double time_step, const std::vector<PairState>& states, const PartMemory& former,
                MotionWork& work, PartMemory& memory) {
  const PartMemory earlier = std::exchange(memory, PartMemory());
  memory.time_step = time_step;
  memory.bodies.reserve(work.bodies.size());
  for (std::size_t i = 0; i < work.bodies.size(); ++i)
    memory.bodies.push_back(begin_of(work.ids[i], work.bodies[i]));
  memory.pairs.reserve(work.pairs.size());
  for (const WorkPair& pair : work.pairs)
    memory.pairs.push_back(row_of(states[at(pair.state)], pair, earlier));
  if (former.time_step != time_step) return;
  const std::vector<char> is_unchanged = find_unchanged(former, memory);
  std::size_t row = 0;
  for (std::size_t p = 0; p < work.pairs.size(); ++p) {
    WorkPair& pair = work.pairs[p];
    if (!is_unchanged[at(pair.a)] || !is_unchanged[at(pair.b)]) continue;
    const PartMemory::Pair& own = memory.pairs[p];
    const std::pair key(own.body_a, own.body_b);
    while (row < former.pairs.size() && std::pair(former.pairs[row].body_a, former.pairs[row].body_b) < key)
      ++row;
    if (row == former.pairs.size()) return;
    const PartMemory::Pair& known = former.pairs[row];
    if (std::pair(known.body_a, known.body_b) == key && known.before == own.before)
      pair.former = static_cast<int>(row);
  }
}

void keep_meetings(const std::vector<PairState>& states, const MotionWork& work, PartMemory& memory) {
  for (std::size_t p = 0; p < memory.pairs.size(); ++p) {
    const WorkPair& pair = work.pairs[p];
    const PairState& state = states[at(pair.state)];
    PartMemory::Pair& row = memory.pairs[p];
    row.is_free_certified = pair.is_free_certified;
    row.is_exempt = state.is_exempt;
    row.passes = pair.passes;
    row.kept_gap = state.kept_gap;
    row.least_gap = pair.least_gap;
    row.gaps = pair.known.start_gaps;
    row.keeps_gaps = state.gaps != nullptr;
  }
}

void end_part(MotionWork& work, PartMemory& memory) {
  for (std::size_t p = 0; p < memory.pairs.size(); ++p)
    memory.pairs[p].contacts = std::move(work.pairs[p].contacts);
}

}  // namespace shatterbox::dynamics
