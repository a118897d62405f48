// What a run did and what it cost: plain data from which the JSON report and the closing words are made.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "engine/audit/audit.h"
#include "engine/geometry/tet_quality.h"
#include "engine/world/inventory.h"
#include "engine/world/report.h"
#include "sandbox/report/trace.h"

namespace shatterbox::sandbox::report {

/// ms in each frame, by the name of what took them.
using TimesByName = std::vector<std::pair<std::string, std::vector<double>>>;

/// One frame: 1/fps of simulated time. Times are wall clock, ms.
struct FrameRecord {
  double frame = 0.0;     // between finished frames
  double simulate = 0.0;  // stepping and making the frame's data
  double render = 0.0;
  double encode = 0.0;  // by the encoder's own clock, and pictures written
  double audit = 0.0;   // in none of the times above
  int contacts = 0;     // most in any of its steps
  int movable = 0;      // dynamic bodies, at its end
  int awake = 0;        // of them: not asleep
  int hits = 0;         // of the continuous pass, summed over its steps
  int impacts = 0;      // evaluated in it
  int breaks = 0;
  long solves = 0;  // of stress
};

struct RunRecord {
  std::string version, scene, goal, compiler, gl_renderer;
  std::uint64_t seed = 1;
  int threads = 1;
  int steps_per_second = 240, frames_per_second = 60;
  double simulated_seconds = 0.0, wall_seconds = 0.0, asked_seconds = 0.0;
  bool is_interrupted = false;
  bool goes_on = false;  // with --resume, if it was interrupted
  std::uint64_t state_hash = 0;
  std::vector<std::uint64_t> frame_hashes;
  int kept_frames = 0;  // of these: drawn by an earlier run, which was cut short
  int bodies_end = 0, pieces = 0;
  long triangles_end = 0;
  world::WorldReport world;
  std::vector<FrameRecord> frames;
  TimesByName stages;                                // in the order of the step
  TimesByName passes;                                // of drawing, in their order, if they were timed
  std::vector<std::pair<std::string, double>> load;  // ms
  std::vector<std::string> used, idle, left_out;     // parts of the program
  std::vector<world::PartCount> inventory;           // at the end
  std::vector<std::pair<std::string, geometry::TetQuality>> tetrahedra;  // of what can break, as it was made
  bool has_sleepers = false;                                             // at the end
  bool has_audit = false;
  audit::AuditReport audit;
  double audit_time = 0.0;               // ms, in no frame's time
  std::vector<std::string> audit_names;  // of the findings' two bodies, in turn
  Trace trace;                           // no rows unless it was asked for
  double peak_memory = 0.0;              // MB
  std::vector<std::string> outputs;
  std::vector<std::string> warnings;
};

}  // namespace shatterbox::sandbox::report
