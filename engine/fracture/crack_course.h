// Which way a crack's tip goes through the next cell: across the first principal stress of the face that it
// follows, a little bent by noise, towards a crack beside it that it is about to join, or along a grain
// boundary.
#pragma once

#include <optional>
#include <vector>

#include "engine/fracture/crack_exit.h"
#include "engine/fracture/crack_set.h"
#include "engine/fracture/decide_shell.h"
#include "engine/fracture/element_plane.h"
#include "engine/fracture/path_noise.h"
#include "engine/fracture/shell_cutter.h"
#include "engine/stress/shell_stress.h"

namespace shatterbox::fracture {

inline constexpr double kRestLength = 4.0;  // thicknesses: length that drives a crack on after a rest

/// Where a load presses and on how large a patch.
struct LoadCentre {
  Vec3 point = Vec3::Zero();
  double radius = 0.0;          // m
  double bending_length = 0.0;  // m: sqrt(radius of curvature x thickness), over which bending dies out
};

/// What does not change while the cracks of a generation run.
struct TracerSetup {
  const ElementPlanes* planes = nullptr;
  /// Pa, per cell of the mesh that the cutter was made from.
  const std::vector<stress::CellStress>* stresses = nullptr;
  const material::Material* material = nullptr;
  const GrainField* grains = nullptr;  // may be null
  const PathNoise* noise = nullptr;
  std::vector<LoadCentre> centres;
  double thickness = 0.0;      // m
  double energy_budget = 0.0;  // J, for this generation; below zero: no guard
  int generation = 0;
  int first_crack = 0;  // number of the next new crack
};

struct NearestLoad {
  const LoadCentre* load = nullptr;
  double distance = 1e300;  // m, at least the radius of its patch
};
NearestLoad find_nearest_load(const TracerSetup& setup, const Vec3& p);

/// A tip while its crack runs.
struct LiveTip {
  CrackTip tip;
  int branch = 0;
  int piece = 0;  // that it runs in, of those that there were when the generation began
  double branch_length = 0.0;
  double driven_length = 0.0;                         // m, of the crack, for the stress intensity
  double intensity = 0.0;                             // K of the last step
  stress::ShellFace face = stress::ShellFace::outer;  // that the crack started on
  bool is_running = true;
  int grain_a = -1, grain_b = -1;  // the boundary it is on
};

/// How a tip comes into a cell: plane coordinates of the cell's element.
struct TipEntry {
  EdgeStretch stretch;
  const ElementPlane* plane = nullptr;
  BorderPlace start;
  Vec2 from = Vec2::Zero();
  Vec2 side = Vec2::UnitX();     // unit, along the border, the cell on its left
  Vec2 heading = Vec2::UnitX();  // unit; over a fold its parts along and across the edge stay

  /// A direction, turned as little as it needs to lead into the cell.
  Vec2 inwards(const Vec2& direction) const;
};

struct Course {
  Vec2 heading = Vec2::UnitX();
  double intensity = 0.0;         // K, Pa sqrt(m)
  std::optional<CrackExit> exit;  // a grain crossing to go to
  bool is_on_grain = false;
  int grain_a = -1, grain_b = -1;
  double toughness_share = 1.0;
  double release_share = 1.0;  // of the stress intensity that is left after turning into a boundary
};

/// All that it is given must outlive it.
class CourseFinder {
 public:
  CourseFinder(const ShellCutter& cutter, const ExitFinder& exits, const TracerSetup& setup,
               const CrackSet& present);

  /// Nothing where the tip cannot go on: at a free edge, or where another cut was met.
  std::optional<TipEntry> enter(const CrackTip& tip) const;

  /// Nothing if the stress cannot drive the tip on. `crack_length`: of both branches, m.
  std::optional<Course> find(const LiveTip& tip, const TipEntry& entry, double crack_length) const;

 private:
  Vec2 steer_to_neighbour(const LiveTip& tip, const TipEntry& entry, const Vec2& heading,
                          double crack_length) const;
  void follow_grains(const LiveTip& tip, const TipEntry& entry, Course& course) const;

  const ShellCutter& cutter_;
  const ExitFinder& exits_;
  const TracerSetup& setup_;
  const CrackSet& present_;  // cracks of this generation
  const geometry::ShellElements& elements_;
  double toughness_ = 0.0;  // K_Ic, Pa sqrt(m)
};

}  // namespace shatterbox::fracture
