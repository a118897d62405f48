// Runs the program as a user does, in a folder of its own.
#pragma once

#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/sandbox/run/folder.h"

namespace shatterbox::sandbox::run {

struct Outcome {
  int status = -1;  // exit status; 128 + signal if one ended it
  std::string out, err;
};

/// Runs a shell command in the folder.
inline Outcome shell(const Folder& folder, const std::string& command) {
  const std::string whole =
      "cd '" + folder.path().string() + "' && ( " + command + " ) >out.txt 2>err.txt </dev/null";
  const int status = std::system(whole.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), read_text(folder / "out.txt"),
          read_text(folder / "err.txt")};
}

/// Runs the program with these arguments.
inline Outcome program(const Folder& folder, const std::string& arguments) {
  return shell(folder, std::string(SHATTERBOX_PROGRAM " ") + arguments);
}

inline nlohmann::json read_json(const fs::path& path) {
  return nlohmann::json::parse(read_text(path));
}

/// Frames that can be decoded, by ffprobe; -1 if the file cannot be read.
inline int count_frames(const Folder& folder, const std::string& video) {
  const Outcome outcome = shell(folder,
                                "ffprobe -v error -count_frames -select_streams v -show_entries "
                                "stream=nb_read_frames -of csv=p=0 " +
                                    video);
  return outcome.status == 0 && !outcome.out.empty() ? std::atoi(outcome.out.c_str()) : -1;
}

/// A scene that costs little: things fall onto a floor, nothing can break.
inline const char* const kSmallScene = R"(# things fall
[scene]
seconds = 0.5
[[body]]
name = "floor"
kind = "plane"
[[body]]
name = "balls"
kind = "sphere"
radius = 0.05
position = [0, 0.2, 0]
repeat = {count = [2, 2, 2], spacing = 0.12, jitter = 0.005}
[[body]]
name = "crate"
kind = "box"
size = 0.1
position = [0.5, 0.3, 0]
rotation = [20, 30, 0]
)";

/// A ball breaks a pane, and the camera goes round it.
inline const char* const kBreakingScene = R"(# a ball breaks a pane
[scene]
seconds = 2
[[body]]
kind = "plane"
position = [0, -0.3, 0]
[[body]]
name = "pane"
kind = "shell"
shape = "pane"
width = 0.4
height = 0.4
edge_length = 0.03
material = "glass"
support = "edge"
[[body]]
name = "ball"
kind = "sphere"
radius = 0.03
position = [0, 0, 1]
velocity = [0, 1, -6]
material = "steel"
[camera]
path = [{at = 0, position = [0, 0, 2], target = [0, 0, 0]}, {at = 2, position = [1, 0, 1.5]}]
[render]
caption = true
)";

}  // namespace shatterbox::sandbox::run
