// shatterbox render: pictures of a recorded run, all or a range of them, without its world.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sandbox/scene/problem.h"

namespace shatterbox::sandbox::run {

struct RenderOptions {
  std::string recording;
  std::string frames;                // "100:200"; empty: all
  std::string video;                 // empty: none; the other outputs likewise
  std::string pictures_folder;       // PNG
  std::string truth_folder;          // depth, normals, ids, cameras
  std::string report;                // JSON
  std::string size, quality;         // empty: as recorded
  std::vector<std::string> changes;  // "camera.position=[0,1,2]": another eye than the recorded one
  std::string gl;                    // as of run
};

/// The first frame and the one behind the last of "100:200", "100:", ":200" or, of all, ""; an end beyond the
/// last frame is the last frame's. Nothing, with a problem, if there is no frame in it.
std::optional<std::pair<int, int>> parse_frames(const std::string& text, int count,
                                                scene::Problems& problems);

/// Draws, encodes, reports. The exit status.
int render_recording(const RenderOptions& options);

}  // namespace shatterbox::sandbox::run
