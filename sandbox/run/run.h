// The verbs of the program. Each returns the exit status and says on stderr what went wrong.
#pragma once

#include "sandbox/run/options.h"

namespace shatterbox::sandbox::run {

/// Simulates, draws, encodes, reports. Without a scene: lists what can be run.
int run_scene(const Options& options);

/// Reads a scene, its meshes and its script and makes its world; says what is wrong, where, and how to mend
/// it.
int check_scene(const Options& options);

/// Scenes, materials, looks, events.
int list_all();

}  // namespace shatterbox::sandbox::run
