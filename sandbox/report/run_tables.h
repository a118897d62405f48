// A run in four tables for other programs: bodies, trajectories, impacts and breaks.
#pragma once

#include <map>
#include <set>
#include <span>
#include <string>

#include "engine/world/world.h"
#include "sandbox/report/table_file.h"

namespace shatterbox::sandbox::report {

/// Who is who: a row a body or piece that a frame showed.
class BodyTable {
 public:
  explicit BodyTable(const std::string& folder);

  /// A frame shows `bodies` at `time` s of the world.
  void add(double time, std::span<const body::Body> bodies);

  /// After the last frame. A sentence if it cannot be written, else empty.
  std::string close(const world::World& world);

 private:
  struct Life {
    body::Body at_birth;
    double gone = -1.0;  // s of the first frame without it; negative: it is there
  };
  TableFile file_;
  std::map<body::BodyId, Life> lives_;
  std::set<body::BodyId> present_;  // in the last frame
};

class RunTables {
 public:
  explicit RunTables(const std::string& folder);

  /// Frame number `frame`: `film` s of the film, which shows `bodies` at `time` s of the world. A sentence if
  /// it cannot be written, else empty.
  std::string add(int frame, double film, double time, std::span<const body::Body> bodies);

  /// After the last frame: what the world's report says, and the end of the files.
  std::string close(const world::World& world);

 private:
  BodyTable bodies_;
  TableFile trajectories_, impacts_, breaks_;
};

}  // namespace shatterbox::sandbox::report
