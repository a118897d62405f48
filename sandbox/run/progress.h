// A progress bar on stderr with the time still needed; where stderr is no terminal a line every half a
// minute.
#pragma once

#include <chrono>
#include <deque>
#include <string>

namespace shatterbox::sandbox::run {

class Progress {
 public:
  Progress(int total, bool is_bar);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// `done` of the total are finished; `note` is shown behind.
  void show(int done, const std::string& note);

  /// Removes the bar.
  void clear();

 private:
  int total_;
  bool is_bar_;
  std::chrono::steady_clock::time_point start_, last_shown_;
  std::deque<std::pair<double, int>> history_;  // seconds since the start, done
};

/// Seconds still needed: from the rate of the last quarter of what is done, so that a run that has become
/// slower says so. Negative while nothing can be said (less than a twentieth or half a second done).
double remaining_seconds(const std::deque<std::pair<double, int>>& history, int total);

/// Whether stderr is a terminal.
bool stderr_is_terminal();

}  // namespace shatterbox::sandbox::run
