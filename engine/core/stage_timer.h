// Wall-clock time by named stage, for the report. Times never enter the state.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/core/clock.h"

namespace shatterbox::core {

/// Sums of time and numbers of calls, in the order in which stages were first seen.
class StageTimer {
 public:
  struct Stage {
    std::string name;
    double milliseconds = 0.0;
    long calls = 0;
  };

  /// Runs `work` and books its time under `name`; returns what it returns.
  template <class Work>
  decltype(auto) time(std::string_view name, Work&& work) {
    const Booking booking(*this, name);
    return std::forward<Work>(work)();
  }

  void add(std::string_view name, double milliseconds);
  const std::vector<Stage>& stages() const { return stages_; }
  /// Time of one stage in milliseconds; 0 if it never ran.
  double milliseconds(std::string_view name) const;
  void clear() { stages_.clear(); }

 private:
  class Booking {
   public:
    Booking(StageTimer& timer, std::string_view name) : timer_(timer), name_(name), start_(Clock::now()) {}
    Booking(const Booking&) = delete;
    Booking& operator=(const Booking&) = delete;
    ~Booking() { timer_.add(name_, milliseconds_since(start_)); }

   private:
    StageTimer& timer_;
    std::string_view name_;
    Clock::time_point start_;
  };

  std::vector<Stage> stages_;
};

}  // namespace shatterbox::core
