// Medians and worst cases of times, and the phases of a run.
#pragma once

#include <string>
#include <vector>

#include "sandbox/report/run_record.h"

namespace shatterbox::sandbox::report {

struct Spread {
  double median = 0.0, p95 = 0.0, max = 0.0;
};

/// Median (the mean of the middle two), 95th percentile (nearest rank) and greatest; zeros without values.
Spread spread_of(std::vector<double> values);

/// The frames of a phase, and what is said of them.
struct Phase {
  std::string name;
  std::vector<std::size_t> frames;     // their numbers, ascending
  std::vector<double> frame_times;     // ms
  double contacts = 0.0, awake = 0.0;  // means
  double awake_share = 0.0;            // mean share of what can move
  long solves = 0;                     // of stress, in all
};

/// before: until something first touches or breaks. impact: more hits of the continuous pass than the median
/// of all frames by ten. breaking: something broke. after: all frames from the first break on. busy: at least
/// 80 % of the greatest number of contacts. rest: nothing that can move is awake, after the first contact. A
/// frame can be in several phases, or in none.
std::vector<Phase> phases_of(const std::vector<FrameRecord>& frames);

/// The times that belong to these frames.
TimesByName times_of(const TimesByName& all, const std::vector<std::size_t>& frames);

}  // namespace shatterbox::sandbox::report
