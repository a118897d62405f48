// METIS draws from the C library's one generator: two threads at once would change each other's answer.
#pragma once

#include <mutex>

namespace shatterbox::stress {

/// Held around every call of METIS.
inline std::mutex& metis_lock() {
  static std::mutex mutex;
  return mutex;
}

}  // namespace shatterbox::stress
