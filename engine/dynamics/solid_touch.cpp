#include "engine/dynamics/solid_touch.h"

#include <algorithm>
#include <cmath>

#include "engine/collision/analytic_contact.h"
#include "engine/geometry/moving_plane.h"

namespace shatterbox::dynamics {
namespace {

using collision::Contact;

constexpr int kMostAdvances = 200;

// Corners of a box, or the centre of a ball, where they begin and end.
struct Corners {
  std::vector<Vec3> from, to;

  explicit Corners(const SolidWay& way) {
    place_at(way.body, way.from, from);
    place_at(way.body, way.to, to);
    for (std::size_t i = 0; i < from.size(); ++i) {
      const Vec3 whole = to[i] - from[i];
      if (way.end < 1.0) to[i] = from[i] + way.end * whole;
      if (way.begin > 0.0) from[i] += way.begin * whole;
    }
  }
  int count() const { return static_cast<int>(from.size()); }
  Vec3 at(int corner, double time) const {
    const auto i = static_cast<std::size_t>(corner);
    return (1.0 - time) * from[i] + time * to[i];
  }
  double lowest(const Vec3& direction, double time) const {
    double result = 1e300;
    for (std::size_t i = 0; i < from.size(); ++i) {
      result = std::min(result, (1.0 - time) * direction.dot(from[i]) + time * direction.dot(to[i]));
    }
    return result;
  }
  std::size_t foremost(const Vec3& direction, double time) const {
    std::size_t best = 0;
    double least = 1e300;
    for (std::size_t i = 0; i < from.size(); ++i) {
      const double height = (1.0 - time) * direction.dot(from[i]) + time * direction.dot(to[i]);
      if (height < least) best = i;
      least = std::min(least, height);
    }
    return best;
  }
  double fastest(const Vec3& direction) const {
    double result = -1e300;
    for (std::size_t i = 0; i < from.size(); ++i) result = std::max(result, direction.dot(to[i] - from[i]));
    return result;
  }
};

/// A face of a box that goes along with it as a separating plane: what turns about an edge comes nearer in
/// every fixed direction, and not to the face.
class MovingFace {
 public:
  /// The face that looks most in `direction` at that share of the way; `corners` are those of its body.
  MovingFace(const SolidWay& way, const Corners& corners, const Vec3& direction, double time)
      : corners_(corners) {
    double best = 0.0;
    for (const geometry::Triangle& t : way.body.collider->triangles) {
      const Vec3 base = corners.at(t[0], time);
      const Vec3 area = (corners.at(t[1], time) - base).cross(corners.at(t[2], time) - base);
      const double facing = direction.dot(area.normalized());
      if (facing <= best) continue;
      best = facing;
      face_ = &t;
    }
  }

  /// Whether all corners of the other, on their straight ways, stay at least `least` (m) above it between
  /// these shares. False of what has no faces.
  bool keeps_off(const Corners& other, double from, double to, double least) const {
    if (face_ == nullptr) return false;
    const auto way = [&](const Corners& whose, int i) {
      return geometry::LinearVector{whose.at(i, from) - corners_.at((*face_)[0], from),
                                    whose.at(i, to) - corners_.at((*face_)[0], to)};
    };
    const geometry::MovingNormal normal(way(corners_, (*face_)[1]), way(corners_, (*face_)[2]));
    for (int i = 0; i < other.count(); ++i)
      for (const double product : normal.times(way(other, i)))
        if (product < least * normal.longest()) return false;
    return true;
  }

 private:
  const Corners& corners_;
  const geometry::Triangle* face_ = nullptr;
};

/// Until which share of the way a face of either keeps the other off by `least` (m) beside its radius, from
/// `time` on; `time` if not even for as long as `shortest`. `normal` is from b to a.
double kept_off_until(const SolidWay& a, const Corners& corners_a, const SolidWay& b,
                      const Corners& corners_b, const Vec3& normal, double time, double least,
                      double shortest) {
  constexpr int kHalvings = 12;
  const MovingFace face_a(a, corners_a, -normal, time), face_b(b, corners_b, normal, time);
  const double height = least + a.body.collider->radius + b.body.collider->radius;
  double way = 1.0 - time;
  for (int i = 0; i < kHalvings && way > shortest; ++i, way *= 0.5) {
    const double end = i == 0 ? 1.0 : time + way;
    if (face_a.keeps_off(corners_b, time, end, height) || face_b.keeps_off(corners_a, time, end, height))
      return end;
  }
  return time;
}

/// Where the foremost corner of one meets the other, for touches in which no face is over the other's.
Contact meet_at_corner(const SolidWay& a, const Corners& corners_a, const SolidWay& b,
                       const Corners& corners_b, const Vec3& normal, double time) {
  const std::size_t i = corners_a.foremost(normal, time), j = corners_b.foremost(-normal, time);
  const Vec3 p = (1.0 - time) * corners_a.from[i] + time * corners_a.to[i];
  const Vec3 q = (1.0 - time) * corners_b.from[j] + time * corners_b.to[j];
  const Vec3 middle = 0.5 * (p + q);
  Contact c;
  c.key = (std::uint64_t{1} << 32U) + 8 * i + j;
  c.normal = normal;
  c.on_a = middle + (p - middle).dot(normal) * normal - a.body.collider->radius * normal;
  c.on_b = middle + (q - middle).dot(normal) * normal + b.body.collider->radius * normal;
  return c;
}

/// A contact of these two poses as the bodies have it where the step begins.
void see_from_start(const SolidWay& a, const Pose& pose_a, const SolidWay& b, const Pose& pose_b,
                    Contact& c) {
  c.on_a = carry(a.body, c.on_a, pose_a, a.body.start);
  c.on_b = carry(b.body, c.on_b, pose_b, b.body.start);
  c.gap = c.normal.dot(c.on_a - c.on_b);
  c.is_time_of_impact = true;
  c.normal_of = collision::NormalOf::place;
}

/// m, along its normal, of a contact seen from the start, where the ways end.
double gap_at_end(const SolidWay& a, const SolidWay& b, const Contact& c) {
  const Vec3 on_a = carry(a.body, c.on_a, a.body.start, a.pose_at(1.0));
  return c.normal.dot(on_a - carry(b.body, c.on_b, b.body.start, b.pose_at(1.0)));
}

/// What touched comes apart again on its way: the contacts of where they are nearest from then on, which
/// other corners and edges may have. What turns about an edge dips on it and is free at the end.
void meet_where_nearest(const SolidWay& a, const SolidWay& b, double margin, double least,
                        SolidTouch& touch) {
  constexpr int kLooks = 16;
  double nearest = 1e300;
  for (int i = kLooks; i >= 1; --i) {
    const double time = i == kLooks ? 1.0 : touch.time + (1.0 - touch.time) * i / kLooks;
    Vec3 normal;
    const double gap =
        collision::analytic_gap(*a.body.shape, a.pose_at(time), *b.body.shape, b.pose_at(time), normal);
    if (gap >= nearest) continue;
    nearest = gap;
    touch.knot = time;
  }
  const Pose pose_a = a.pose_at(touch.knot), pose_b = b.pose_at(touch.knot);
  std::vector<Contact> contacts;
  collision::find_analytic_contacts(*a.body.shape, pose_a, *b.body.shape, pose_b,
                                    margin + std::max({0.0, least, nearest}), contacts);
  for (Contact& c : contacts) see_from_start(a, pose_a, b, pose_b, c);
  touch.contacts.insert(touch.contacts.end(), contacts.begin(), contacts.end());
}

}  // namespace

SolidTouch find_first_touch(const SolidWay& a, const SolidWay& b, double least, double margin) {
  const Corners corners_a(a), corners_b(b);
  const double radii = a.body.collider->radius + b.body.collider->radius;
  const double close_enough = std::max(0.0, 0.1 * least);
  SolidTouch result;
  double time = 0.0;
  for (int i = 0; i < kMostAdvances; ++i) {
    const bool is_last = i + 1 == kMostAdvances;  // who is not through by then has touched
    const Pose pose_a = a.pose_at(time), pose_b = b.pose_at(time);
    Vec3 normal;
    const double gap = collision::analytic_gap(*a.body.shape, pose_a, *b.body.shape, pose_b, normal);
    const auto separation = [&](double t) {
      return corners_a.lowest(normal, t) + corners_b.lowest(-normal, t) - radii;
    };
    // The least corner of straight paths is concave in time: apart at both ends is apart all along.
    const double room = separation(time) - least;
    if (room >= 0.0 && separation(1.0) >= least) return result;
    const double closing = corners_a.fastest(-normal) + corners_b.fastest(normal);
    const double until = kept_off_until(a, corners_a, b, corners_b, normal, time, least,
                                        closing > 0.0 ? std::max(0.0, room / closing) : 0.0);
    if (until == 1.0) return result;
    if (until > time && !is_last) {
      time = until;
      continue;
    }
    if (room <= close_enough || closing <= 0.0 || is_last) {
      // Corners that go straight touch where rigid bodies, which turn, may still be farther apart.
      collision::find_analytic_contacts(*a.body.shape, pose_a, *b.body.shape, pose_b,
                                        margin + std::max({0.0, least, gap}), result.contacts);
      if (result.contacts.empty())
        result.contacts.push_back(meet_at_corner(a, corners_a, b, corners_b, normal, time));
      for (Contact& c : result.contacts) see_from_start(a, pose_a, b, pose_b, c);
      result.has_touched = true;
      result.time = time;
      const auto is_open = [&](const Contact& c) { return gap_at_end(a, b, c) > least; };
      if (time < 1.0 && std::all_of(result.contacts.begin(), result.contacts.end(), is_open))
        meet_where_nearest(a, b, margin, least, result);
      return result;
    }
    time = std::min(1.0, time + 0.999 * room / closing);
  }
  return result;
}

}  // namespace shatterbox::dynamics
