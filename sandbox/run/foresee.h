// What will become of a scene's bodies, found out by trying: each that can break is stepped, without
// pictures, among others that cannot, until it breaks or the scene is over.
#pragma once

#include <string>
#include <vector>

#include "sandbox/scene/build_world.h"

namespace shatterbox::sandbox::run {

/// One [[body]] that can break, with its copies.
struct Foreseen {
  std::string body;           // of its name
  int copies = 1;             // in the scene
  bool is_alone = false;      // only the highest of its copies was tried, and no other body that can break
  bool has_others = false;    // others can break, but could not in the trial
  std::string other;          // what it met hardest; empty: it met nothing
  double speed = 0.0;         // m/s, with which it met that
  double time = 0.0;          // s, when it met that, or when it broke
  double ratio = 0.0;         // greatest stress over strength; 0: never so near that it had to be solved for
  bool was_given_up = false;  // the trial took too long to be played to the end
  double given_up_at = 0.0;   // s of the world: the step that began then was not over
  double patience = 0.0;      // s, after which that was
  int pieces = 0;             // kAftermath after it broke; 0: it held
  double break_ms = 0.0;      // the dearest step of that time
  double later_ms = 0.0;      // the median one
  double all_ms = 0.0;        // all of them
  double bytes = 0.0;         // of arrays that are there then and were not before
};

/// Of the first `most` bodies that can break. Scenes of more than kMostTogether bodies are tried alone. What
/// takes longer than `patience` (s), until the break or behind it, is given up.
std::vector<Foreseen> foresee(const scene::SceneDescription& scene, const scene::ScenePlan& plan,
                              std::size_t most, double patience = 10.0);

inline constexpr int kMostTogether = 50;
inline constexpr double kAftermath = 0.025;  // s that are stepped on after a break

/// In a line, for people.
std::string describe(const Foreseen& foreseen);

}  // namespace shatterbox::sandbox::run
