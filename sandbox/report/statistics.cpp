#include "sandbox/report/statistics.h"

#include <algorithm>
#include <cmath>

namespace shatterbox::sandbox::report {

Spread spread_of(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const std::size_t count = values.size();
  const double median = 0.5 * (values[(count - 1) / 2] + values[count / 2]);
  const auto rank = static_cast<std::size_t>(std::ceil(0.95 * static_cast<double>(count)));
  return {median, values[std::max<std::size_t>(rank, 1) - 1], values.back()};
}

std::vector<Phase> phases_of(const std::vector<FrameRecord>& frames) {
  constexpr double kMoreHits = 10.0;  // than usual: many things met at once
  const std::vector<const char*> names{"before", "impact", "breaking", "after", "busy", "rest"};
  std::vector<Phase> phases(names.size());
  for (std::size_t i = 0; i < phases.size(); ++i) phases[i].name = names[i];
  int most = 0;
  std::vector<double> hits;
  for (const FrameRecord& frame : frames) {
    most = std::max(most, frame.contacts);
    hits.push_back(frame.hits);
  }
  const double usual_hits = spread_of(hits).median;
  bool has_begun = false, has_broken = false;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const FrameRecord& frame = frames[k];
    has_begun = has_begun || frame.contacts > 0 || frame.impacts > 0 || frame.breaks > 0;
    has_broken = has_broken || frame.breaks > 0;
    const bool is_in[] = {
        !has_begun, frame.hits > usual_hits + kMoreHits,      frame.breaks > 0,
        has_broken, most > 0 && frame.contacts >= 0.8 * most, has_begun && frame.awake == 0};
    for (std::size_t i = 0; i < phases.size(); ++i) {
      if (!is_in[i]) continue;
      phases[i].frames.push_back(k);
      phases[i].frame_times.push_back(frame.frame);
      phases[i].contacts += frame.contacts;
      phases[i].awake += frame.awake;
      phases[i].awake_share += frame.movable > 0 ? static_cast<double>(frame.awake) / frame.movable : 0.0;
      phases[i].solves += frame.solves;
    }
  }
  for (Phase& phase : phases) {
    const auto count = static_cast<double>(std::max<std::size_t>(1, phase.frame_times.size()));
    phase.contacts /= count;
    phase.awake /= count;
    phase.awake_share /= count;
  }
  return phases;
}

TimesByName times_of(const TimesByName& all, const std::vector<std::size_t>& frames) {
  TimesByName some;
  for (const auto& [name, times] : all) {
    std::vector<double>& own = some.emplace_back(name, std::vector<double>()).second;
    for (const std::size_t frame : frames)
      if (frame < times.size()) own.push_back(times[frame]);
  }
  return some;
}

}  // namespace shatterbox::sandbox::report
