#include "engine/core/stage_timer.h"

#include <algorithm>

namespace shatterbox::core {

void StageTimer::add(std::string_view name, double milliseconds) {
  auto stage = std::find_if(stages_.begin(), stages_.end(), [&](const Stage& s) { return s.name == name; });
  if (stage == stages_.end()) stage = stages_.insert(stages_.end(), Stage{std::string(name), 0.0, 0});
  stage->milliseconds += milliseconds;
  ++stage->calls;
}

double StageTimer::milliseconds(std::string_view name) const {
  for (const Stage& stage : stages_)
    if (stage.name == name) return stage.milliseconds;
  return 0.0;
}

}  // namespace shatterbox::core
