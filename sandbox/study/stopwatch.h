// Processor time of this process, all its threads together: what a setting costs, whoever else is at work.
#pragma once

#include <ctime>

namespace shatterbox::sandbox::study {

class Stopwatch {
 public:
  /// s since it was made.
  double seconds() const { return now() - start_; }

 private:
  static double now() {
    timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }
  double start_ = now();
};

}  // namespace shatterbox::sandbox::study
