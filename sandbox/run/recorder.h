// Gathers what a run did, frame by frame, from the world's own report.
#pragma once

#include <string>

#include "engine/world/world.h"
#include "sandbox/report/run_record.h"
#include "sandbox/run/painter.h"

namespace shatterbox::sandbox::run {

class Recorder {
 public:
  report::RunRecord record;

  /// Keeps a trace of that world, which is to live as long.
  void watch(world::World& world);
  /// A step of it was broken off.
  void note_broken_off(const world::World& world);
  /// After one step.
  void note_step(const world::World& world);
  /// After the steps of one frame, which took `simulate` ms, and the audit of them `audit` ms more.
  void note_frame(const world::World& world, double simulate, double audit);
  /// Times and hashes of the pictures that are this record's: its frames begin with number `first` of the
  /// film.
  void note_pictures(const Painted& painted, int first);
  /// What has been made of optional parts of the picture; the world's come with finish().
  void note_parts(const std::vector<world::PartCount>& parts);
  /// At the end: counts, hash, memory, what was used.
  void finish(const world::World& world, double wall_seconds);

 private:
  report::Tracer tracer_;
  int most_contacts_ = 0;  // in this frame
  int hits_ = 0;           // in this frame
  std::size_t impacts_ = 0, breaks_ = 0;
  long solves_ = 0;
  std::vector<double> stage_sums_;
};

}  // namespace shatterbox::sandbox::run
