// Closest points of points, segments, triangles and boxes. Exactly degenerate input (a triangle that is a
// segment or a point) is answered like the segment or point that it is.
#pragma once

#include "engine/core/vec.h"

namespace shatterbox::geometry {

struct PointTriangle {
  Vec3 barycentric = Vec3::Zero();  // weights of a, b, c; never negative, sum 1
  Vec3 closest = Vec3::Zero();      // on the triangle
  double distance = 0.0;            // m
};

/// The point of triangle (a, b, c) closest to p.
PointTriangle closest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

struct SegmentSegment {
  double s = 0.0, t = 0.0;  // in [0, 1]: weights of p1 and q1
  Vec3 on_p = Vec3::Zero(), on_q = Vec3::Zero();
  double distance = 0.0;  // m
};

/// Closest points of the segments p0-p1 and q0-q1; of parallel ones some pair of closest points.
SegmentSegment closest_between_segments(const Vec3& p0, const Vec3& p1, const Vec3& q0, const Vec3& q1);

struct PointBox {
  Vec3 closest = Vec3::Zero();   // on the box's surface
  Vec3 normal = Vec3::UnitY();   // outward at `closest`, from it towards a point outside
  double signed_distance = 0.0;  // m; negative inside
};

/// The point of the surface of the box of `half_extent` about the origin closest to p, inside or outside.
PointBox closest_on_box(const Vec3& p, const Vec3& half_extent);

}  // namespace shatterbox::geometry
