// The command line: verbs and options, as `shatterbox --help` tells them.
#pragma once

namespace shatterbox::sandbox::run {

/// Parses the arguments, runs the verb, returns the exit status.
int run_command_line(int argc, char** argv);

}  // namespace shatterbox::sandbox::run
