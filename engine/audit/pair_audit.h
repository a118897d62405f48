// The audit of one pair of bodies in one step: all features of one against those of the other.
#pragma once

#include <array>
#include <vector>

#include "engine/audit/audit.h"
#include "engine/audit/surface.h"

namespace shatterbox::audit {

struct PairFindings {
  std::vector<Finding> list;  // step, time and bodies still to be filled in
  long unsettled = 0;
  bool has_crossing = false;  // at the end of the step

  void add(FindingKind kind, int feature_a, int feature_b);
};

/// Two bodies made of triangles. Crossings are told at the end of the step alone.
void audit_surfaces(const Surface& a, const MovingSurface& moving_a, const Surface& b,
                    const MovingSurface& moving_b, bool is_end, PairFindings& findings);

/// True if they cross at the start or at the end of the step (`when`).
bool do_cross(const Surface& a, const MovingSurface& moving_a, const Surface& b,
              const MovingSurface& moving_b, std::vector<Vec3> MovingSurface::*when);

/// Vertices with a radius against the half space y < 0 of `plane`. The plane is b.
void audit_plane(const MovingSurface& moving, double radius, const Pose& plane, PairFindings& findings);
bool is_below_plane(const std::vector<Vec3>& points, double radius, const Pose& plane);

/// Triangles against a ball of `radius` whose centre moves along a straight line. The sphere is b.
void audit_sphere(const Surface& a, const MovingSurface& moving_a, const Vec3& centre_start,
                  const Vec3& centre_end, double radius, bool is_end, PairFindings& findings);
bool crosses_sphere_at_start(const Surface& a, const MovingSurface& moving_a, const Vec3& centre,
                             double radius);

/// Two balls whose centres move along straight lines, from [0] to [1].
struct MovingBall {
  std::array<Vec3, 2> centre;
  double radius = 0.0;
};
void audit_balls(const MovingBall& a, const MovingBall& b, bool is_end, PairFindings& findings);
bool do_balls_cross_at_start(const MovingBall& a, const MovingBall& b);

}  // namespace shatterbox::audit
