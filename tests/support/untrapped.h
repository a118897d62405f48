// While it lives, numbers that are none do not end the test, and all runs on this thread: for tests of what
// is to survive them.
#pragma once

#include <cfenv>

#include "engine/core/parallel.h"

namespace shatterbox::test {

class Untrapped {
 public:
  Untrapped() : traps_(fedisableexcept(FE_INVALID)) { core::set_thread_count(1); }
  ~Untrapped() {
    core::set_thread_count(0);
    std::feclearexcept(FE_INVALID);
    feenableexcept(traps_);
  }
  Untrapped(const Untrapped&) = delete;
  Untrapped& operator=(const Untrapped&) = delete;

 private:
  int traps_;
};

}  // namespace shatterbox::test
