// What a run works on: a scene, its world and its outputs, read and made from what the command line asks.
#pragma once

#include <optional>
#include <string>

#include "sandbox/run/options.h"
#include "sandbox/run/outputs.h"
#include "sandbox/run/painter.h"
#include "sandbox/run/recorder.h"
#include "sandbox/scene/build_world.h"

namespace shatterbox::sandbox::run {

struct Job {
  Options options;  // with a video if there is no other output
  PainterSettings painter;
  std::optional<scene::SceneDescription> scene;
  std::optional<scene::BuiltScene> built;
};

/// Reads everything; what is wrong goes to `problems`. Fills what the record says before the first step.
Job make_job(const Options& options, Recorder& recorder, scene::Problems& problems);

/// What a run reads: its scene, which `who` names, with the meshes of its bodies.
void add_scene(const std::string& who, const std::string& file,
               const std::optional<scene::SceneDescription>& scene, Outputs& outputs);

/// What a run with these options writes.
void add_outputs(const Options& options, Outputs& outputs);

/// The video that a run makes: the one asked for, or, if there is no other output, one of the scene's name.
std::string film_of(const Options& options);

/// What is wrong, on stderr; the exit status.
int refuse(const scene::Problems& problems);

}  // namespace shatterbox::sandbox::run
