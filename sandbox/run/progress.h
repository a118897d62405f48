// A progress bar on stderr with the time still needed; where stderr is no terminal a line every half a
// minute. Both go on while one frame takes long.
#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <span>
#include <string>
#include <thread>

namespace shatterbox::sandbox::run {

class Progress {
 public:
  /// `patience`: how long nothing is said at most.
  Progress(int total, bool is_bar, std::chrono::milliseconds patience);
  Progress(int total, bool is_bar);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// `done` of the total are finished, more than which none are; `note` is shown behind.
  void show(int done, const std::string& note);

  /// Removes the bar; nothing is said any more.
  void clear();

 private:
  using Time = std::chrono::steady_clock::time_point;

  void wait_for_news(const std::stop_token& stops);
  void say(Time now, const std::string& left, const std::string& note);

  const int total_;
  const bool is_bar_;
  const std::chrono::milliseconds patience_;
  const Time start_;
  std::mutex mutex_;  // of all that follows
  bool is_over_ = false;
  bool is_news_ = false;  // that is not shown yet
  Time last_shown_, last_news_;
  int done_ = 0;
  std::string note_;
  std::deque<std::pair<double, int>> history_;  // seconds since the start, done
  std::condition_variable_any wakes_;
  std::jthread watch_;  // the last: it ends before what it reads
};

/// Seconds still needed: from the rate of the last quarter of what is done, so that a run that has become
/// slower says so. Negative while nothing can be said (less than a twentieth or half a second done).
double remaining_seconds(const std::deque<std::pair<double, int>>& history, int total);

/// How far a film is whose frames were played so far that it is at `shown` (ascending) after each: after the
/// last of those that are finished, too. `finished` may be more of them, which an earlier run has left and
/// which are to be played again, or negative, while the shots before this one are drawn.
int reached(std::span<const int> shown, int finished);

/// Whether stderr is a terminal.
bool stderr_is_terminal();

}  // namespace shatterbox::sandbox::run
