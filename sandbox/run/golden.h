// The verb `golden`: a folder of scenes with pictures and state hashes that must come out again.
//
// DIR/NAME/golden.json holds the scene, the options of `run`, the hash of the state at the end, and why it
// was made or made again; beside it lie the pictures.
#pragma once

#include <string>
#include <vector>

#include "sandbox/run/diff.h"
#include "sandbox/run/options.h"

namespace shatterbox::sandbox::run {

struct GoldenOptions {
  std::string folder;
  Options run;                     // of one to make: scene, size, stills, ...
  std::string name;                // of one to make; empty: the scene's
  std::string reason;              // why it is made, or made again
  std::vector<std::string> names;  // to check; empty: all
  FindingOptions findings;         // of a check; pictures: DIR/NAME/frame_000012.png
};

/// Makes one golden of a scene; without a scene, makes those that are there again. Returns the exit status.
int make_goldens(const GoldenOptions& options);

/// Runs every golden's scene again and compares. Returns the exit status.
int check_goldens(const GoldenOptions& options);

}  // namespace shatterbox::sandbox::run
