// The program: shatterbox run | check | plan | render | batch | diff | golden | study | bench | list. See
// sandbox/README.md.
#include <cstdio>
#include <exception>

#if defined(__GLIBC__)
#include <malloc.h>
#endif

#include "sandbox/run/command_line.h"
#include "sandbox/run/options.h"

namespace {

/// A frame in which something breaks takes and leaves many blocks of megabytes. Kept, they need not be asked
/// of the system, and zeroed by it page after page, again and again.
void keep_freed_memory() {
#if defined(__GLIBC__)
  mallopt(M_MMAP_THRESHOLD, 32 << 20);  // bytes; the most that glibc takes
  mallopt(M_TRIM_THRESHOLD, 512 << 20);
  mallopt(M_TOP_PAD, 16 << 20);
#endif
}

}  // namespace

int main(int argc, char** argv) {
  keep_freed_memory();
  try {
    return shatterbox::sandbox::run::run_command_line(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "failed: %s\n", error.what());
    return shatterbox::sandbox::run::kFailed;
  }
}
