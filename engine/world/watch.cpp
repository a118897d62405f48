// Who watches a world is shown its state behind every stage.
#include "engine/world/bits.h"

namespace shatterbox::world {

void World::watch(Watcher watcher) {
  state_->watcher = std::move(watcher);
}

void World::tell_watcher(const char* stage, const dynamics::StepPart& part, int pass) const {
  const State& s = *state_;
  if (!s.watcher) return;
  s.watcher({stage, s.steps + 1, part.number + 1, part.count, pass + 1, s.moving.bodies,
             hash_bodies(s.moving, s.element_stress), hash_contacts(s.moving)});
}

}  // namespace shatterbox::world
