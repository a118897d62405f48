// A step that is asked to stop: what it has changed so far is put back.
#include "engine/world/state.h"

namespace shatterbox::world {

void World::set_stop(core::StopQuestion wants_to_stop) {
  state_->wants_to_stop = std::move(wants_to_stop);
}

StepBegin World::note_begin() const {
  const State& s = *state_;
  StepBegin begin;
  if (!s.wants_to_stop) return begin;
  begin.hands = s.hands;
  begin.conservation = s.report.conservation;
  begin.solver = s.report.solver;
  begin.joints = s.report.joints;
  begin.impacts = s.report.impacts.size();
  begin.breaks = s.report.breaks.size();
  begin.dents = s.report.dents.size();
  begin.triangles_most = s.report.triangles_most;
  begin.tetrahedra_end = s.report.tetrahedra_end;
  begin.tetrahedra_most = s.report.tetrahedra_most;
  begin.last_energy = s.last_energy;
  begin.is_disturbed = s.is_disturbed;
  return begin;
}

/// Before the first break of the step, which changes the snapshot.
void World::keep_begin(const MovingState& snapshot) {
  State& s = *state_;
  if (!s.wants_to_stop || s.begin.element_stress) return;
  if (!s.begin.moving) s.begin.moving = snapshot;
  s.begin.element_stress = s.element_stress;
}

void World::put_back(MovingState&& snapshot) {
  State& s = *state_;
  StepBegin& begin = s.begin;
  s.moving = begin.moving ? std::move(*begin.moving) : std::move(snapshot);
  s.ancestry.erase(s.ancestry.lower_bound(s.moving.next_id), s.ancestry.end());
  if (begin.element_stress) s.element_stress = std::move(*begin.element_stress);
  s.hands = std::move(begin.hands);
  s.report.conservation = begin.conservation;
  s.report.solver = begin.solver;
  s.report.joints = std::move(begin.joints);
  s.report.impacts.resize(begin.impacts);
  s.report.breaks.resize(begin.breaks);
  s.report.dents.resize(begin.dents);
  s.report.triangles_most = begin.triangles_most;
  s.report.tetrahedra_end = begin.tetrahedra_end;
  s.report.tetrahedra_most = begin.tetrahedra_most;
  s.last_energy = begin.last_energy;
  s.is_disturbed = begin.is_disturbed;
  s.log.clear();
  s.begin = {};
}

}  // namespace shatterbox::world
