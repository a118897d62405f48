// The program: shatterbox run | check | plan | render | batch | diff | golden | study | bench | list. See
// sandbox/README.md.
#include <cstdio>
#include <exception>

#include "sandbox/run/command_line.h"
#include "sandbox/run/options.h"

int main(int argc, char** argv) {
  try {
    return shatterbox::sandbox::run::run_command_line(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "failed: %s\n", error.what());
    return shatterbox::sandbox::run::kFailed;
  }
}
