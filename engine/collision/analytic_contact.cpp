#include "engine/collision/analytic_contact.h"

#include <algorithm>
#include <cmath>

#include "engine/core/index.h"
#include "engine/geometry/closest_points.h"

namespace shatterbox::collision {
namespace {

using body::Shape;
using body::ShapeKind;
using core::at;

void add_sphere_sphere(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b, Contact& c) {
  const Vec3 way = pose_a.translation - pose_b.translation;
  const double distance = way.norm();
  c.normal = distance > 0.0 ? Vec3(way / distance) : Vec3::UnitY();
  c.gap = distance - a.radius - b.radius;
  c.on_a = pose_a.translation - a.radius * c.normal;
  c.on_b = pose_b.translation + b.radius * c.normal;
  c.normal_of = NormalOf::ball;
}

// The sphere is a.
void add_sphere_box(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b, Contact& c) {
  const auto nearest = geometry::closest_on_box(pose_b.apply_inverse(pose_a.translation), b.half_extent);
  c.normal = pose_b.rotation * nearest.normal;
  c.gap = nearest.signed_distance - a.radius;
  c.on_b = pose_b.apply(nearest.closest);
  c.on_a = pose_a.translation - a.radius * c.normal;
  c.lean = 1.0;
  c.normal_of = NormalOf::ball;
}

struct Axis {
  Vec3 normal;      // unit, from b towards a
  double gap;       // separation along it
  int number = -1;  // 0-2 faces of a, 3-5 faces of b, 6-14 edge i of a x edge j of b
};

constexpr double kNoOverlap = 1e-6;  // of the size: boxes that touch may do so by rounding

// The axis of greatest separation. Where contacts are wanted (`prefers_faces`) an edge pair must be better by
// a little, so that faces that lie on each other are not taken for edges; but what one axis tells apart does
// not overlap.
Axis best_axis(const Shape& a, const Mat3& ra, const Shape& b, const Mat3& rb, const Vec3& way,
               bool prefers_faces) {
  const double size = prefers_faces ? std::min(a.half_extent.minCoeff(), b.half_extent.minCoeff()) : 0.0;
  Axis best{Vec3::UnitY(), -1e300, -1};
  const auto try_axis = [&](const Vec3& direction, int number, double handicap) {
    const double side = direction.dot(way) < 0.0 ? -1.0 : 1.0;
    const double gap = std::abs(direction.dot(way)) -
                       (ra.transpose() * direction).cwiseAbs().dot(a.half_extent) -
                       (rb.transpose() * direction).cwiseAbs().dot(b.half_extent);
    if (gap > best.gap + (best.gap < -kNoOverlap * size ? 0.0 : handicap))
      best = {side * direction, gap, number};
  };
  for (int i = 0; i < 3; ++i) try_axis(ra.col(i), i, 0.0);
  for (int i = 0; i < 3; ++i) try_axis(rb.col(i), 3 + i, 1e-3 * size);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const Vec3 cross = ra.col(i).cross(rb.col(j));
      const double length = cross.norm();
      const bool may_overlap = !prefers_faces || best.gap < -kNoOverlap * size;
      if (length > (may_overlap ? 1e-7 : 1e-3)) try_axis(cross / length, 6 + 3 * i + j, 5e-3 * size);
    }
  }
  return best;
}

// Keeps the part of the polygon where direction.x <= limit.
void clip(std::vector<Vec3>& polygon, const Vec3& direction, double limit) {
  std::vector<Vec3> result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3& p = polygon[i];
    const Vec3& q = polygon[(i + 1) % polygon.size()];
    const double dp = direction.dot(p) - limit, dq = direction.dot(q) - limit;
    if (dp <= 0.0) result.push_back(p);
    if ((dp < 0.0 && dq > 0.0) || (dp > 0.0 && dq < 0.0)) result.push_back(p + (q - p) * (dp / (dp - dq)));
  }
  polygon = std::move(result);
}

struct PlacedBox {
  const Shape& shape;
  Mat3 axes;
  Vec3 centre;
};

// `outward` points out of the reference box's face `axis`; the incident box's most opposed face is clipped to
// it.
void add_face_contacts(const PlacedBox& reference, int axis, const Vec3& outward, const PlacedBox& incident,
                       bool reference_is_a, double margin, int number, std::vector<Contact>& out) {
  int face = 0;
  const Vec3 alignment = incident.axes.transpose() * outward;
  alignment.cwiseAbs().maxCoeff(&face);
  const double face_side = alignment[face] > 0.0 ? -1.0 : 1.0;
  const int u = (face + 1) % 3, v = (face + 2) % 3;
  const Vec3 centre =
      incident.centre + face_side * incident.shape.half_extent[face] * incident.axes.col(face);
  const Vec3 du = incident.shape.half_extent[u] * incident.axes.col(u);
  const Vec3 dv = incident.shape.half_extent[v] * incident.axes.col(v);
  std::vector<Vec3> polygon = {centre - du - dv, centre + du - dv, centre + du + dv, centre - du + dv};
  for (const int side : {(axis + 1) % 3, (axis + 2) % 3}) {
    const Vec3 direction = reference.axes.col(side);
    const double middle = direction.dot(reference.centre);
    clip(polygon, direction, reference.shape.half_extent[side] + middle);
    clip(polygon, -direction, reference.shape.half_extent[side] - middle);
  }
  const double plane = outward.dot(reference.centre) + reference.shape.half_extent[axis];
  const bool is_upper = reference.axes.col(axis).dot(outward) > 0.0;
  const auto faces = static_cast<std::uint64_t>(2 * number + (is_upper ? 1 : 0)) << 16 |
                     static_cast<std::uint64_t>(2 * face + (face_side > 0.0 ? 1 : 0)) << 8;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const double gap = outward.dot(polygon[i]) - plane;
    if (gap > margin) continue;
    Contact c;
    // Polygon corners keep their number while the clipping does not change: good enough to find last step's
    // impulse.
    c.key = faces | static_cast<std::uint64_t>(i);
    const Vec3 on_reference = polygon[i] - gap * outward;
    c.gap = gap;
    c.normal = reference_is_a ? Vec3(-outward) : outward;
    c.normal_of = reference_is_a ? NormalOf::face_a : NormalOf::face_b;
    c.on_a = reference_is_a ? on_reference : polygon[i];
    c.on_b = reference_is_a ? polygon[i] : on_reference;
    out.push_back(c);
  }
}

// Of four parallel edges the one that lies furthest in a direction.
struct BoxEdge {
  Vec3 middle, half;
  std::uint64_t number = 0;  // which of them, below 8
};
BoxEdge furthest_edge(const PlacedBox& box, int along, const Vec3& direction) {
  BoxEdge edge{box.centre, box.shape.half_extent[along] * box.axes.col(along)};
  for (int i = 0; i < 3; ++i) {
    if (i == along) continue;
    const bool is_upper = box.axes.col(i).dot(direction) > 0.0;
    edge.middle += (is_upper ? 1.0 : -1.0) * box.shape.half_extent[i] * box.axes.col(i);
    if (is_upper) edge.number |= std::uint64_t{1} << i;
  }
  return edge;
}

void add_edge_contact(const PlacedBox& a, const PlacedBox& b, const Axis& axis, std::vector<Contact>& out) {
  const BoxEdge edge_a = furthest_edge(a, (axis.number - 6) / 3, -axis.normal);
  const BoxEdge edge_b = furthest_edge(b, (axis.number - 6) % 3, axis.normal);
  const auto nearest =
      geometry::closest_between_segments(edge_a.middle - edge_a.half, edge_a.middle + edge_a.half,
                                         edge_b.middle - edge_b.half, edge_b.middle + edge_b.half);
  Contact c;
  c.key = static_cast<std::uint64_t>(2 * axis.number) << 16 | edge_a.number << 8 | edge_b.number;
  c.on_a = nearest.on_p;
  c.on_b = nearest.on_q;
  c.normal = axis.normal;
  c.gap = axis.normal.dot(c.on_a - c.on_b);
  set_crossing_edges(edge_a.half, edge_b.half, c);
  out.push_back(c);
}

void add_box_box(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b, double margin,
                 std::vector<Contact>& out) {
  const PlacedBox box_a{a, pose_a.rotation.toRotationMatrix(), pose_a.translation};
  const PlacedBox box_b{b, pose_b.rotation.toRotationMatrix(), pose_b.translation};
  const Axis axis = best_axis(a, box_a.axes, b, box_b.axes, pose_a.translation - pose_b.translation, true);
  if (axis.gap > margin) return;
  const std::size_t first = out.size();
  if (axis.number < 3) {
    add_face_contacts(box_a, axis.number, -axis.normal, box_b, true, margin, axis.number, out);
  } else if (axis.number < 6) {
    add_face_contacts(box_b, axis.number - 3, axis.normal, box_a, false, margin, axis.number, out);
  } else {
    add_edge_contact(box_a, box_b, axis, out);
    return;
  }
  // A face that slides on a greater one takes its contacts with it.
  const double size_a = a.half_extent.maxCoeff(), size_b = b.half_extent.maxCoeff();
  const double lean = size_a < size_b ? 1.0 : size_a > size_b ? 0.0 : 0.5;
  for (std::size_t i = first; i < out.size(); ++i) out[i].lean = lean;
}

}  // namespace

void find_plane_contacts(const Collider& a, const std::vector<Vec3>& positions_a, const Pose& plane,
                         double margin, std::vector<Contact>& out) {
  constexpr double kSlack = 0.1;  // sine of the angle by which a neighbour may lie lower
  const Vec3 normal = plane.rotation * Vec3::UnitY();
  const double level = normal.dot(plane.translation);
  for (std::size_t v = 0; v < positions_a.size(); ++v) {
    const double gap = normal.dot(positions_a[v]) - level - a.radius;
    if (gap > margin) continue;
    bool is_lowest = true;
    for (int i = a.neighbour_begin[v]; i < a.neighbour_begin[v + 1] && is_lowest; ++i) {
      const Vec3 edge = positions_a[at(a.neighbours[at(i)])] - positions_a[v];
      const double down = -normal.dot(edge);
      is_lowest = down <= 0.0 || down * down <= kSlack * kSlack * edge.squaredNorm();
    }
    if (!is_lowest) continue;
    Contact c;
    c.key = static_cast<std::uint64_t>(v);
    c.normal = normal;
    c.gap = gap;
    c.on_a = positions_a[v] - a.radius * normal;
    c.on_b = c.on_a - gap * normal;
    c.lean = 1.0;
    out.push_back(c);
  }
}

bool is_analytic_pair(ShapeKind a, ShapeKind b) {
  const auto is_solid = [](ShapeKind kind) { return kind == ShapeKind::box || kind == ShapeKind::sphere; };
  return is_solid(a) && is_solid(b);
}

Contact find_ball_contact(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b) {
  Contact c;
  if (a.kind == ShapeKind::sphere && b.kind == ShapeKind::sphere) {
    add_sphere_sphere(a, pose_a, b, pose_b, c);
  } else if (a.kind == ShapeKind::sphere) {
    add_sphere_box(a, pose_a, b, pose_b, c);
  } else {
    add_sphere_box(b, pose_b, a, pose_a, c);
    std::swap(c.on_a, c.on_b);
    c.normal = -c.normal;
    c.lean = 0.0;
  }
  return c;
}

void find_analytic_contacts(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b,
                            double margin, std::vector<Contact>& out) {
  if (a.kind == ShapeKind::box && b.kind == ShapeKind::box) {
    add_box_box(a, pose_a, b, pose_b, margin, out);
    return;
  }
  const Contact c = find_ball_contact(a, pose_a, b, pose_b);
  if (c.gap <= margin) out.push_back(c);
}

double analytic_gap(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b, Vec3& normal) {
  if (a.kind == ShapeKind::box && b.kind == ShapeKind::box) {
    const Axis axis = best_axis(a, pose_a.rotation.toRotationMatrix(), b, pose_b.rotation.toRotationMatrix(),
                                pose_a.translation - pose_b.translation, false);
    normal = axis.normal;
    return axis.gap;
  }
  const Contact c = find_ball_contact(a, pose_a, b, pose_b);
  normal = c.normal;
  return c.gap;
}

double box_contact_gap(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b) {
  return best_axis(a, pose_a.rotation.toRotationMatrix(), b, pose_b.rotation.toRotationMatrix(),
                   pose_a.translation - pose_b.translation, true)
      .gap;
}

}  // namespace shatterbox::collision
