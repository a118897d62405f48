// Distance of a feature pair, and whether its straight path keeps a least distance: conservative advancement
// along fixed separating directions, which has no false negatives.
#pragma once

#include <array>
#include <vector>

#include "engine/collision/collider.h"
#include "engine/collision/contact.h"
#include "engine/collision/feature_list.h"
#include "engine/core/vec.h"

namespace shatterbox::collision {

/// The up to four vertices of a feature pair: [vertex, triangle] or [edge of a, edge of b].
struct FeaturePoints {
  bool is_edge_edge = false;
  bool is_flipped = false;                // the vertex is body b's
  double radius_a = 0.0, radius_b = 0.0;  // m, about the features of either body
  std::array<Vec3, 4> points;

  double radii() const { return radius_a + radius_b; }
};

/// Gathers them from vertex positions of both bodies.
FeaturePoints gather(const FeaturePair& pair, const Collider& a, const std::vector<Vec3>& positions_a,
                     const Collider& b, const std::vector<Vec3>& positions_b);

/// Gathers them where both bodies have these poses.
FeaturePoints gather(const FeaturePair& pair, const Collider& a, const Pose& pose_a, const Collider& b,
                     const Pose& pose_b);

struct FeatureGap {
  std::array<double, 4> weights{};                // of the four points in the closest points
  Vec3 on_a = Vec3::Zero(), on_b = Vec3::Zero();  // m, world, on the surfaces (radii included)
  Vec3 normal = Vec3::UnitY();                    // unit, from b towards a
  double gap = 0.0;                               // m, radii subtracted; negative only where there are any
  double distance = -1.0;                         // m, of the features themselves; negative: not measured
};

/// Closest points of the pair. Where they coincide the normal is the triangle's or the edges' common normal,
/// its sign chosen along `hint` (from b towards a).
FeatureGap measure(const FeaturePoints& points, const Vec3& hint);

/// How far the features are apart along a direction, unit, from b towards a, m: at most their gap.
double separation_along(const FeaturePoints& points, const Vec3& direction);

/// The same of features with the vertices of both bodies at these positions.
double separation_along(const FeaturePair& pair, const Collider& a, const std::vector<Vec3>& positions_a,
                        const Collider& b, const std::vector<Vec3>& positions_b, const Vec3& direction);

/// True if the distance of the two *surfaces*, not only of these features, is least here: neighbouring
/// features of either mesh lead away from the other. Slack: sine of the angle by which they may lead closer.
bool is_local_minimum(const FeaturePair& pair, const FeatureGap& gap, const Collider& a,
                      const std::vector<Vec3>& positions_a, const Collider& b,
                      const std::vector<Vec3>& positions_b, double slack);

struct PathResult {
  bool has_hit = false;
  double time = 1.0;     // share of the path that is certainly free
  double spare = 1e300;  // m, without a hit: free too are all paths that stay this close to it
  FeatureGap gap;        // at `time` if it has hit
};

/// Follows the straight paths from `start` to `end`. Free means that the gap never falls to `least` (a pair
/// that starts closer than that must only not approach). `start_gap` spares the measure at the start.
PathResult follow_paths(const FeaturePoints& start, const FeaturePoints& end, double least, const Vec3& hint,
                        const FeatureGap* start_gap = nullptr);

/// Features that are near as a contact: `here` are the pair's points, `gap` their gap.
Contact contact_here(const FeaturePair& features, const FeaturePoints& here, const FeatureGap& gap);

/// A hit on the path as a contact seen from the start: the material points of both bodies that will meet, and
/// their distance along the direction in which they will. `start` are the pair's points there, `hit` its gap
/// at the impact.
Contact contact_at_impact(const FeaturePair& features, const FeaturePoints& start, const FeatureGap& hit);

/// Whether features of the two, where they are placed, are as near as `distance` (m), radii subtracted. Needs
/// `boxes` of both.
bool are_within(const PlacedCollider& a, const PlacedCollider& b, double distance);

}  // namespace shatterbox::collision
