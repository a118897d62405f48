// A run in four tables for other programs: bodies, trajectories, impacts and breaks.
#pragma once

#include <map>
#include <set>
#include <span>
#include <string>

#include "engine/world/world.h"
#include "sandbox/report/table_file.h"

namespace shatterbox::sandbox::report {

class RunTables {
 public:
  explicit RunTables(const std::string& folder);

  /// Frame number `frame`: `film` s of the film, which shows `bodies` at `time` s of the world. A sentence if
  /// it cannot be written, else empty.
  std::string add(int frame, double film, double time, std::span<const body::Body> bodies);

  /// After the last frame: what the world's report says, and the end of the files.
  std::string close(const world::World& world);

 private:
  struct Life {
    body::Body at_birth;
    double gone = -1.0;  // s of the first frame without it; negative: it is there
  };
  void write_bodies(const world::World& world);

  TableFile bodies_, trajectories_, impacts_, breaks_;
  std::map<body::BodyId, Life> lives_;
  std::set<body::BodyId> present_;  // in the last frame
};

}  // namespace shatterbox::sandbox::report
