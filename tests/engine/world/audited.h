// A world that is looked at by the audit after every step.
#pragma once

#include "engine/audit/audit.h"
#include "engine/world/world.h"

namespace shatterbox::test {

/// Steps until `seconds` of the world's time; tells the audit of breaks and dents.
inline audit::AuditReport run_audited(world::World& world, double seconds) {
  world.keep_ways();
  audit::Audit audit;
  std::size_t dents = 0, breaks = 0;
  while (world.time() < seconds) {
    audit.begin_step(world.bodies());
    world.step();
    std::vector<audit::Birth> births;
    for (; breaks < world.report().breaks.size(); ++breaks)
      for (const body::BodyId id : world.report().breaks[breaks].born)
        births.push_back({id, world.report().breaks[breaks].id});
    for (; dents < world.report().dents.size(); ++dents)
      if (world.report().dents[dents].born != 0)
        births.push_back({world.report().dents[dents].born, world.report().dents[dents].id});
    audit.end_step(world.bodies(), births, world.ways(), world.time());
  }
  return audit.report();
}

}  // namespace shatterbox::test
