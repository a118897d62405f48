// Linked into a test program, turns floating-point traps on before anything runs.
#include <cfenv>

namespace {

[[maybe_unused]] const int kTraps = feenableexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);

}  // namespace
