#include "engine/world/striker.h"

#include <algorithm>

#include "engine/body/polyhedron.h"

namespace shatterbox::world {
namespace {

constexpr double kFrontDepth = 0.05;  // of the section's diameter: how deep its front is looked at
constexpr double kRoundFront = 0.25;  // of the section: a ball's front is about that large, and not flat

/// The striker's corners: across its motion, and how far ahead.
struct Corners {
  std::vector<Vec2> across;   // m
  std::vector<double> ahead;  // m
  std::vector<geometry::Triangle> triangles;
};

Corners find_corners(const geometry::TriangleMesh& mesh, const Mat3& struck_from_striker,
                     const fracture::Striker& striker) {
  Corners corners;
  corners.triangles = mesh.triangles;
  for (const Vec3& vertex : mesh.positions) {
    const Vec3 place = struck_from_striker * vertex;
    corners.across.emplace_back(striker.first.dot(place), striker.second.dot(place));
    corners.ahead.push_back(striker.direction.dot(place));
  }
  return corners;
}

double area_of(const std::vector<Vec2>& polygon) {
  fracture::Striker stamp;
  stamp.core = polygon;
  return fracture::section_of(stamp).area;
}

/// The share of its section that is in front at once: the hull of what is less than `depth` behind its
/// foremost point.
double front_share(const Corners& corners, double depth, double area) {
  const double level = *std::max_element(corners.ahead.begin(), corners.ahead.end()) - depth;
  std::vector<Vec2> front;
  for (const geometry::Triangle& t : corners.triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const auto a = static_cast<std::size_t>(t[i]), b = static_cast<std::size_t>(t[(i + 1) % 3]);
      const double over_a = corners.ahead[a] - level, over_b = corners.ahead[b] - level;
      if (over_a >= 0.0) front.push_back(corners.across[a]);
      if ((over_a > 0.0) == (over_b > 0.0) || !(over_a != over_b)) continue;
      front.push_back(corners.across[a] +
                      over_a / (over_a - over_b) * (corners.across[b] - corners.across[a]));
    }
  return area_of(fracture::convex_hull(std::move(front))) / area;
}

void set_section(const body::Shape& shape, const Mat3& struck_from_striker, fracture::Striker& striker) {
  if (body::is_round(shape.kind)) {
    striker.radius = shape.radius;
    const Vec3 end = struck_from_striker * Vec3(0.0, shape.half_length, 0.0);
    const Vec2 across(striker.first.dot(end), striker.second.dot(end));
    const bool is_long = across.norm() > 1e-9 * shape.radius;
    striker.core = is_long ? fracture::convex_hull({across, -across}) : std::vector<Vec2>{Vec2::Zero()};
    return;
  }
  const Corners corners = find_corners(body::find_polyhedron(shape), struck_from_striker, striker);
  if (corners.across.empty()) return;
  striker.core = fracture::convex_hull(corners.across);
  const fracture::StrikerSection section = section_of(striker);
  if (!(section.area > 0.0)) return;
  const double share = front_share(corners, kFrontDepth * section.diameter, section.area);
  striker.flatness = std::clamp((share - kRoundFront) / (1.0 - kRoundFront), 0.0, 1.0);
}

/// Where two met first.
struct FirstTouch {
  const body::LoggedImpulse* entry = nullptr;
  bool is_as_begun = true;  // the striker had met nobody else until then
};

FirstTouch find_first_touch(const body::ImpulseLog& log, body::BodyId struck, body::BodyId striker) {
  FirstTouch touch;
  // Who was turned away by others before he touched has a closing speed, but gave nothing.
  const auto is_of = [](const body::LoggedImpulse& entry, body::BodyId id) {
    return entry.kind == body::ImpulseKind::collision && (entry.body_a == id || entry.body_b == id) &&
           entry.impulse_a.squaredNorm() > 0.0 && entry.impulse_b.squaredNorm() > 0.0;
  };
  const auto is_before = [](const body::LoggedImpulse& entry, const body::LoggedImpulse& other) {
    if (entry.time != other.time) return entry.time < other.time;
    return entry.closing_speed > other.closing_speed;
  };
  for (const body::LoggedImpulse& entry : log)
    if (is_of(entry, striker) && is_of(entry, struck) && (!touch.entry || is_before(entry, *touch.entry)))
      touch.entry = &entry;
  if (!touch.entry) return touch;
  touch.is_as_begun = std::none_of(log.begin(), log.end(), [&](const body::LoggedImpulse& entry) {
    return is_of(entry, striker) && !is_of(entry, struck) && entry.time < touch.entry->time;
  });
  return touch;
}

}  // namespace

std::shared_ptr<const fracture::Striker> find_striker(const PartBegin& begin, const body::ImpulseLog& log,
                                                      body::BodyId struck_id, body::BodyId other_id) {
  const body::Body* struck = body::find_body(begin.bodies, struck_id);
  const body::Body* other = body::find_body(begin.bodies, other_id);
  if (!struck || !other || !other->is_dynamic() || other->shape->kind == body::ShapeKind::plane)
    return nullptr;
  // Of one metal, neither is rigid to the other.
  if (struck->family != 0 && struck->family == other->family) return nullptr;
  const FirstTouch touch = find_first_touch(log, struck_id, other_id);
  if (!touch.entry || !(touch.entry->closing_speed > 0.0)) return nullptr;
  const bool is_a = touch.entry->body_a == struck_id;
  const Vec3 point_body = is_a ? touch.entry->point_a : touch.entry->point_b;
  const Vec3 other_point = is_a ? touch.entry->point_b : touch.entry->point_a;
  const Quat to_struck = struck->pose.rotation.conjugate();
  const Mat3 struck_from_striker = (to_struck * other->pose.rotation).toRotationMatrix();
  const Vec3 impulse_body = is_a ? touch.entry->impulse_a : touch.entry->impulse_b;
  Vec3 velocity = to_struck * (other->velocity - struck->velocity_at(struck->pose.apply(point_body)));
  // Who has met a third one before has another motion since, of which only this is known.
  if (!touch.is_as_begun || !(velocity.dot(impulse_body) > 0.0))
    velocity = touch.entry->closing_speed * impulse_body.normalized();

  fracture::Striker striker;
  striker.number = other_id;
  striker.speed = velocity.norm();
  striker.direction = velocity / striker.speed;
  int least = 0;
  striker.direction.cwiseAbs().minCoeff(&least);
  striker.first = striker.direction.cross(Vec3::Unit(least)).normalized();
  striker.second = striker.direction.cross(striker.first);
  striker.mass = 1.0 / other->inverse_mass;
  // Where it was when they met: they met in one point of both.
  const Vec3 centre_body = point_body - struck_from_striker * other_point;
  striker.centre = centre_body + struck->shape->material_from_body;
  striker.place = point_body + struck->shape->material_from_body;
  striker.struck_inverse_mass = struck->mobility(centre_body, striker.direction);
  striker.time = begin.step_time + touch.entry->time;
  set_section(*other->shape, struck_from_striker, striker);
  return std::make_shared<const fracture::Striker>(std::move(striker));
}

}  // namespace shatterbox::world
