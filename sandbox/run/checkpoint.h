// A run that is cut short, even by kill -9, goes on with --resume. What it has drawn and encoded is kept; the
// world steps again from its start, without pictures, and must pass through the very state that the
// checkpoint saw.
#pragma once

#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "sandbox/run/job.h"

namespace shatterbox::sandbox::run {

class Checkpoint {
 public:
  /// Of a film of these jobs, which are all made.
  explicit Checkpoint(const std::vector<const Job*>& jobs);

  /// Reads what an earlier run has left, if there is anything. What makes it no beginning of this run goes to
  /// `problems`.
  void load(scene::Problems& problems);
  /// There is none of an earlier run from now on: this one begins at its start.
  void discard() const;

  /// Pictures that need not be drawn again, ascending: as many as are really there.
  const std::vector<Picture>& kept() const { return kept_; }

  /// At each frame: compares the state where the earlier run left it, and writes a checkpoint every second. A
  /// sentence if that failed, or if this is another run.
  std::string pass(int shot, const world::World& world, const Painter* painter);
  /// Writes one now, at the same place.
  std::string save(const Painter* painter);

  /// Beside the first output; empty where there is none.
  const std::string& file() const { return file_; }

 private:
  struct State {
    int shot = -1;
    long steps = 0;
    std::string hash;
  };

  void keep_pictures(const nlohmann::json& pictures);

  std::string file_, video_, frames_folder_, truth_folder_;
  std::vector<std::pair<std::string, std::string>> settings_;  // names and values, which must be the same
  State now_, left_;                                           // of this run; of the earlier one
  std::vector<Picture> kept_;
  std::chrono::steady_clock::time_point saved_;
};

}  // namespace shatterbox::sandbox::run
