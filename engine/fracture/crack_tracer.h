// Cracks of one generation: where they start, and how they run from element to element across the first
// principal stress of the face that they started on, until they arrest, reach an edge, or meet another cut.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/fracture/crack_course.h"

namespace shatterbox::fracture {

/// A flaw that the stress is above.
struct Candidate {
  int element = 0;
  Vec2 barycentric = Vec2::Zero();
  double overload = 0.0;  // stress / strength, above 1
  int number = 0;         // breaks ties
  int piece = 0;          // that it is in, of those that the last cracks left
};

/// Runs cracks through a cutter. One object a generation.
class CrackTracer {
 public:
  CrackTracer(ShellCutter& cutter, TracerSetup setup);

  /// Lets tips of earlier generations run on. Those that cannot stay open. `pieces`: of each cell of the mesh
  /// that the cutter was made from.
  void resume(const std::vector<CrackTip>& tips, const std::vector<int>& pieces);
  /// Starts cracks at the candidates, most overloaded first, not too near to each other.
  void nucleate(std::vector<Candidate> candidates);

  const std::vector<CrackSegment>& segments() const { return segments_; }
  const std::vector<CrackTip>& open_tips() const { return open_tips_; }
  int crack_count() const { return next_crack_ - setup_.first_crack; }
  double energy() const { return energy_; }  // J, used
  bool is_out_of_energy() const { return is_out_of_energy_; }

 private:
  void run(std::array<LiveTip, 2>& tips, int count);
  void advance(LiveTip& tip, double& crack_length);
  void arrest(LiveTip& tip);
  bool cut_along(LiveTip& tip, const TipEntry& entry, const Course& course, double& crack_length);
  bool go_over(const CrackExit& exit, int element, CrackTip& tip) const;
  bool try_start(const Candidate& candidate);
  bool is_shielded(const Candidate& candidate) const;
  bool pay(double length, double toughness_share);
  void record(const LiveTip& tip, const ElementPlane& plane, const Vec2& from, const Vec2& to, int side_id,
              bool is_on_grain);

  ShellCutter& cutter_;
  TracerSetup setup_;
  const geometry::ShellElements& elements_;
  ExitFinder exits_;
  CrackSet present_;  // cracks of this generation
  CourseFinder courses_;
  std::vector<double> crack_lengths_;  // of this generation's new cracks, by number - first_crack
  std::vector<CrackSegment> segments_;
  std::vector<CrackTip> open_tips_;
  int next_crack_ = 0;
  double energy_ = 0.0;
  bool is_out_of_energy_ = false;
};

}  // namespace shatterbox::fracture
