// What the command line asks of `run` and `check`.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "render/renderer.h"
#include "sandbox/scene/problem.h"
#include "sandbox/scene/read_scene.h"

namespace shatterbox::sandbox::run {

// Exit statuses of the program.
inline constexpr int kDone = 0;
inline constexpr int kDiffers = 1;   // a difference, or a failed check
inline constexpr int kBadInput = 2;  // bad input or usage
inline constexpr int kFailed = 3;    // failed, or was interrupted, while running

struct Options {
  std::string scene;           // path or name; empty: none given
  std::string video;           // empty: NAME.mp4, unless there is another output
  std::string frames_folder;   // PNG
  std::vector<double> stills;  // s: only these moments are drawn; empty: all
  std::string meshes_folder;   // OBJ
  std::string model;           // glTF
  std::string tables_folder;   // CSV and JSON
  std::string truth_folder;    // depth, normals, ids, cameras
  std::string recording;       // of the pictures before they are drawn
  std::string report;          // JSON
  std::string size = "640x360";
  int frames_per_second = 60;
  std::string quality = "preview";
  std::string gl;  // "osmesa" or "egl"; empty: the usual one
  std::optional<double> seconds;
  std::optional<long long> seed;
  int threads = 0;  // 0: one a core
  std::vector<std::string> overrides;
  std::string compare;  // NAME.key=a,b: beside each other
  std::string script;
  bool has_pictures = true;
  bool has_audit = false;
  bool has_trace = false;  // in the report
  bool resumes = false;    // goes on from what an earlier run has left
};

/// The size of "640x360"; nothing, with a problem, if it is none (16 to 8192 each, even for video).
std::optional<render::Size> parse_size(const std::string& text, scene::Problems& problems);

/// "full", or the preview.
render::Quality parse_quality(const std::string& text);

/// What --gl names, or the usual one without a name; one that there is not goes to `problems`.
render::BackEnd parse_back_end(const std::string& text, scene::Problems& problems);

/// --set, --seconds, --seed and --script, as changes to a scene.
scene::SceneChanges changes_of(const Options& options);

/// A name that no video can have, or a kind of video that this build cannot write. An empty name is none.
void check_video(const std::string& file, scene::Problems& problems);

}  // namespace shatterbox::sandbox::run
