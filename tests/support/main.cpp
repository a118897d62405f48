// The entry of every test program; engine tests turn floating-point traps on before anything runs.
#define CATCH_CONFIG_RUNNER
#include <catch2/catch.hpp>

#ifdef SHATTERBOX_TRAP_FLOATS
#include <cfenv>
#endif

int main(int argc, char* argv[]) {
#ifdef SHATTERBOX_TRAP_FLOATS
  feenableexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
#endif
  return Catch::Session().run(argc, argv);
}
