// What a run's state was behind every stage of every step, as hashes: what changed, quantity by quantity.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "engine/world/moment.h"

namespace shatterbox::sandbox::report {

/// Behind one stage. `changed` lists bodies by their ids and, of each, quantities by their places in
/// trace_quantities() with eight digits of their hashes: "17 0:1a2b3c4d 2:5e6f7a8b;18 0:..". Body 0 stands
/// for what is between bodies.
struct TraceRow {
  long step = 0;
  int part = 0, parts = 0, pass = 0;
  std::string stage, changed;
};

struct Trace {
  std::map<body::BodyId, std::string> names;  // of all bodies there ever were
  std::vector<TraceRow> rows;
};

/// "position", .. of a body; the last one is "contacts", of none.
std::vector<std::string> trace_quantities();

/// Writes a trace while it watches a world.
class Tracer {
 public:
  void note(const world::Moment& moment);
  /// That step was broken off.
  void drop_step(long step);

  Trace trace;

 private:
  std::map<body::BodyId, world::BodyBits> last_;
  std::uint64_t last_contacts_ = 0;
};

}  // namespace shatterbox::sandbox::report
