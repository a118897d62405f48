// What a fuzz target is: a function of bytes that must come back, whatever they are. Linked with libFuzzer
// (preset fuzz), or with mutate.cpp, which plays the corpus and a fixed number of changes of it.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

namespace fuzz {

/// Of the target's own file.
int run_one(std::string_view bytes);

inline void require(bool is_so, const char* what) {
  if (is_so) return;
  std::fprintf(stderr, "not so: %s\n", what);
  std::abort();
}

}  // namespace fuzz
