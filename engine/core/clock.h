// Wall-clock time for figures; nothing of the state may depend on it.
#pragma once

#include <chrono>

namespace shatterbox::core {

using Clock = std::chrono::steady_clock;

inline double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

}  // namespace shatterbox::core
