#include "sandbox/run/inspector.h"

#include "engine/core/clock.h"

namespace shatterbox::sandbox::run {

namespace {

using core::Clock;

std::string name_of(const world::World& world, body::BodyId id) {
  const body::Body* found = body::find_body(world.bodies(), id);
  return found != nullptr ? found->name : std::string();
}

}  // namespace

Inspector::Inspector(bool is_on, report::RunRecord& record) : record_(record) {
  record_.has_audit = is_on;
}

void Inspector::begin_step(const world::World& world) {
  if (!record_.has_audit) return;
  const auto start = Clock::now();
  audit_.begin_step(world.bodies());
  record_.audit_time += core::milliseconds_since(start);
}

void Inspector::end_step(const world::World& world) {
  if (!record_.has_audit) return;
  const auto start = Clock::now();
  std::vector<audit::Birth> births;
  const auto& breaks = world.report().breaks;
  for (; breaks_ < breaks.size(); ++breaks_)
    for (const body::BodyId child : breaks[breaks_].born) births.push_back({child, breaks[breaks_].id});
  const auto& dents = world.report().dents;
  for (; dents_ < dents.size(); ++dents_)
    if (dents[dents_].born != 0) births.push_back({dents[dents_].born, dents[dents_].id});
  audit_.end_step(world.bodies(), births, world.ways(), world.time());
  record_.audit = audit_.report();
  for (std::size_t i = record_.audit_names.size() / 2; i < record_.audit.findings.size(); ++i) {
    record_.audit_names.push_back(name_of(world, record_.audit.findings[i].a));
    record_.audit_names.push_back(name_of(world, record_.audit.findings[i].b));
  }
  record_.audit_time += core::milliseconds_since(start);
}

}  // namespace shatterbox::sandbox::run
