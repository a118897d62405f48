#include "engine/geometry/closest_points.h"

#include <algorithm>
#include <cmath>

namespace shatterbox::geometry {
namespace {

double weight_on_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 ab = b - a;
  const double length_squared = ab.squaredNorm();
  return length_squared > 0.0 ? std::clamp((p - a).dot(ab) / length_squared, 0.0, 1.0) : 0.0;
}

}  // namespace

PointTriangle closest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  PointTriangle result;
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const Vec3 normal = ab.cross(ac);
  const double area_squared = normal.squaredNorm();
  if (area_squared > 0.0) {
    const double wc = ab.cross(ap).dot(normal);
    const double wb = ap.cross(ac).dot(normal);
    const double wa = area_squared - wb - wc;
    if (wa >= 0.0 && wb >= 0.0 && wc >= 0.0) {
      result.barycentric = Vec3(wa, wb, wc) / area_squared;
      result.closest = a + result.barycentric[1] * ab + result.barycentric[2] * ac;
      result.distance = (p - result.closest).norm();
      return result;
    }
  }
  const Vec3* corners[3] = {&a, &b, &c};
  double best = -1.0;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const double w = weight_on_segment(p, *corners[i], *corners[j]);
    const Vec3 q = w < 1.0 ? Vec3(*corners[i] + w * (*corners[j] - *corners[i])) : *corners[j];
    const double distance_squared = (p - q).squaredNorm();
    if (best >= 0.0 && distance_squared >= best) continue;
    best = distance_squared;
    result.barycentric.setZero();
    result.barycentric[i] = 1.0 - w;
    result.barycentric[j] = w;
    result.closest = q;
  }
  result.distance = std::sqrt(best);
  return result;
}

SegmentSegment closest_between_segments(const Vec3& p0, const Vec3& p1, const Vec3& q0, const Vec3& q1) {
  SegmentSegment result;
  const Vec3 d = p1 - p0, e = q1 - q0, r = p0 - q0;
  const double dd = d.squaredNorm(), ee = e.squaredNorm(), de = d.dot(e);
  const double dr = d.dot(r), er = e.dot(r);
  const double determinant = dd * ee - de * de;
  if (dd > 0.0 && ee > 0.0) {
    // Of nearly parallel segments any s will do; the clamps below then find a closest partner.
    if (determinant > 1e-14 * dd * ee) result.s = std::clamp((de * er - dr * ee) / determinant, 0.0, 1.0);
    result.t = (de * result.s + er) / ee;
    if (result.t < 0.0) {
      result.t = 0.0;
      result.s = std::clamp(-dr / dd, 0.0, 1.0);
    } else if (result.t > 1.0) {
      result.t = 1.0;
      result.s = std::clamp((de - dr) / dd, 0.0, 1.0);
    }
  } else if (dd > 0.0) {
    result.s = std::clamp(-dr / dd, 0.0, 1.0);
  } else if (ee > 0.0) {
    result.t = std::clamp(er / ee, 0.0, 1.0);
  }
  result.on_p = p0 + result.s * d;
  result.on_q = q0 + result.t * e;
  result.distance = (result.on_p - result.on_q).norm();
  return result;
}

PointBox closest_on_box(const Vec3& p, const Vec3& half_extent) {
  PointBox result;
  const Vec3 clamped = p.cwiseMax(-half_extent).cwiseMin(half_extent);
  const Vec3 outside = p - clamped;
  const double distance = outside.norm();
  if (distance > 0.0) {
    result.closest = clamped;
    result.normal = outside / distance;
    result.signed_distance = distance;
    return result;
  }
  int axis = 0;
  double depth = half_extent[0] - std::abs(p[0]);
  for (int i = 1; i < 3; ++i) {
    const double d = half_extent[i] - std::abs(p[i]);
    if (d < depth) {
      depth = d;
      axis = i;
    }
  }
  const double side = p[axis] < 0.0 ? -1.0 : 1.0;
  result.closest = p;
  result.closest[axis] = side * half_extent[axis];
  result.normal = Vec3::Zero();
  result.normal[axis] = side;
  result.signed_distance = -depth;
  return result;
}

}  // namespace shatterbox::geometry
