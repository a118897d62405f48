// Cracks of one generation: where they start, and how they run from element to element across the first
// principal stress of the face that they started on, until they arrest, reach an edge, or meet another cut.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/fracture/crack_exit.h"
#include "engine/fracture/crack_set.h"
#include "engine/fracture/decide_shell.h"
#include "engine/fracture/element_plane.h"
#include "engine/fracture/path_noise.h"
#include "engine/fracture/shell_cutter.h"
#include "engine/stress/shell_stress.h"

namespace shatterbox::fracture {

/// Where a load presses and on how large a patch.
struct LoadCentre {
  Vec3 point = Vec3::Zero();
  double radius = 0.0;
};

/// A flaw that the stress is above.
struct Candidate {
  int element = 0;
  Vec2 barycentric = Vec2::Zero();
  double overload = 0.0;  // stress / strength, above 1
  int number = 0;         // breaks ties
};

/// What does not change while the cracks of a generation run.
struct TracerSetup {
  const std::vector<ElementPlane>* planes = nullptr;
  const std::vector<stress::CellStress>* stresses =
      nullptr;  // Pa, per cell of the mesh that the cutter was made from
  const material::Material* material = nullptr;
  const GrainField* grains = nullptr;  // may be null
  const PathNoise* noise = nullptr;
  std::vector<LoadCentre> centres;
  double thickness = 0.0;      // m
  double energy_budget = 0.0;  // J, for this generation; below zero: no guard
  int generation = 0;
  int first_crack = 0;  // number of the next new crack
};

/// Runs cracks through a cutter. One object a generation.
class CrackTracer {
 public:
  CrackTracer(ShellCutter& cutter, TracerSetup setup);

  /// Lets tips of earlier generations run on. Those that cannot stay open.
  void resume(const std::vector<CrackTip>& tips);
  /// Starts cracks at the candidates, most overloaded first, not too near to each other.
  void nucleate(std::vector<Candidate> candidates);

  const std::vector<CrackSegment>& segments() const { return segments_; }
  const std::vector<CrackTip>& open_tips() const { return open_tips_; }
  int crack_count() const { return next_crack_ - setup_.first_crack; }
  int resumed_count() const { return resumed_count_; }
  double energy() const { return energy_; }  // J, used
  bool is_out_of_energy() const { return is_out_of_energy_; }

 private:
  struct LiveTip {
    CrackTip tip;
    int branch = 0;
    double branch_length = 0.0;
    double driven_length = 0.0;  // m, of the crack, for the stress intensity
    double intensity = 0.0;      // K of the last step
    bool is_running = true;
    int grain_a = -1, grain_b = -1;  // the boundary it is on
  };
  struct Course {
    Vec2 heading;
    std::optional<CrackExit> exit;  // a grain crossing to go to
    bool is_on_grain = false;
    int grain_a = -1, grain_b = -1;
    double toughness_share = 1.0;
    double release_share = 1.0;  // of the stress intensity that is left after turning into a boundary
  };

  void run(std::array<LiveTip, 2>& tips, int count, stress::ShellFace face);
  void advance(LiveTip& tip, stress::ShellFace face, double& crack_length);
  void arrest(LiveTip& tip);
  Course choose_course(const LiveTip& tip, const EdgeStretch& entry, const Vec2& start, Vec2 heading,
                       const stress::PlaneStress& tensor, double crack_length) const;
  Vec2 steer_to_neighbour(const LiveTip& tip, const ElementPlane& plane, const Vec2& start,
                          const Vec2& heading, double crack_length) const;
  void follow_grains(const LiveTip& tip, const EdgeStretch& entry, const Vec2& start, Course& course) const;
  bool try_start(const Candidate& candidate);
  bool is_shielded(const Candidate& candidate) const;
  double distance_to_load(const Vec3& p) const;
  double stress_intensity(const stress::PlaneStress& tensor, const Vec2& along, double length) const;
  bool pay(double length, double toughness_share);
  void record(const LiveTip& tip, const ElementPlane& plane, const Vec2& from, const Vec2& to, int side_id,
              bool is_on_grain);

  ShellCutter& cutter_;
  TracerSetup setup_;
  const geometry::ShellElements& elements_;
  ExitFinder exits_;
  CrackSet present_;                   // cracks of this generation
  std::vector<double> crack_lengths_;  // of this generation's new cracks, by number - first_crack
  std::vector<CrackSegment> segments_;
  std::vector<CrackTip> open_tips_;
  int next_crack_ = 0;
  int resumed_count_ = 0;
  double energy_ = 0.0;
  bool is_out_of_energy_ = false;
  double toughness_ = 0.0;  // K_Ic, Pa sqrt(m)
};

}  // namespace shatterbox::fracture
