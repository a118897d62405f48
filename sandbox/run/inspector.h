// --audit: the world's steps, checked from outside.
#pragma once

#include "engine/audit/audit.h"
#include "engine/world/world.h"
#include "sandbox/report/run_record.h"

namespace shatterbox::sandbox::run {

class Inspector {
 public:
  /// Books into `record`; does nothing unless `is_on`.
  Inspector(bool is_on, report::RunRecord& record);

  /// Before and after a step.
  void begin_step(const world::World& world);
  void end_step(const world::World& world);

 private:
  report::RunRecord& record_;
  audit::Audit audit_;
  std::size_t breaks_ = 0, dents_ = 0;  // rows of the world's report that are known
};

}  // namespace shatterbox::sandbox::run
