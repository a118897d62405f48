#include "sandbox/view/subject.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include "engine/geometry/bvh.h"
#include "sandbox/view/framing.h"
#include "sandbox/view/ways.h"

namespace shatterbox::sandbox::view {
namespace {

constexpr double kRoomForPieces = 1.6;   // times as wide as what fell further than it is large
constexpr double kRoomToTip = 1.2;       // of its height, to either side of its middle
constexpr double kWorthGoing = 1.3;      // times as far the eye would have to be, to see all of the fall
constexpr double kSideways = 0.5;        // m/s: what goes aside faster does not just fall
constexpr double kRoomForScenery = 1.0;  // on each side, of the size of what moves or breaks
constexpr double kRoomToComeIn = 0.6;    // the same, for what is thrown or dropped at it

// What neither moves nor breaks, nor comes in later.
bool is_scenery(const scene::BodyEntry& body) {
  return body.motion == body::Motion::fixed && !body.is_held_back && !scene::can_break(body);
}

bool can_fall(const scene::BodyEntry& body, bool is_hung) {
  return body.motion == body::Motion::dynamic && !is_hung && !is_on_axle(body);
}

// A box in axes of which the second goes down.
geometry::Box upright(const Corners& corners, const Vec3& down) {
  const Vec3 aside = down.unitOrthogonal(), across = down.cross(aside);
  geometry::Box box;
  for (const Vec3& p : corners) box.include(Vec3(p.dot(aside), p.dot(down), p.dot(across)));
  return box;
}

struct Scenery {
  std::vector<Corners> corners;
  std::vector<geometry::Box> upright;  // of each; none if nothing pulls
};

Scenery find_scenery(const scene::SceneDescription& scene, const scene::ScenePlan& plan) {
  Scenery scenery;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const scene::BodyEntry& body = scene.bodies[i];
    if (plan.bodies[i].bounding_radius <= 0.0 || !is_scenery(body)) continue;
    for (const Pose& pose : scene::copy_poses(body, scene.world.seed, i))
      scenery.corners.push_back(corners_of(plan.bodies[i].box, pose));
  }
  if (scene.world.gravity.isZero(0.0)) return scenery;
  for (const Corners& corners : scenery.corners)
    scenery.upright.push_back(upright(corners, scene.world.gravity.normalized()));
  return scenery;
}

// The way that what has these corners would fall to the nearest plane below it that is at most `kSteepest`
// steep, or to scenery; zero if it stands there, nothing if there is none, or if nothing pulls.
std::optional<Vec3> way_down(const scene::SceneDescription& scene, const Scenery& scenery,
                             const Corners& corners) {
  constexpr double kSteepest = 0.7;   // cosine of the angle between gravity and the plane's normal
  constexpr double kStanding = 0.01;  // of its height
  const Vec3& gravity = scene.world.gravity;
  if (gravity.isZero(0.0)) return std::nullopt;
  const geometry::Box from = upright(corners, gravity.normalized());
  const double standing = kStanding * (from.high.y() - from.low.y()) / gravity.norm();
  std::optional<double> nearest;
  const auto lands = [&](double way) {
    if (way >= -standing && way < nearest.value_or(1e300)) nearest = std::max(way, 0.0);
  };
  for (const scene::BodyEntry& entry : scene.bodies) {
    if (!std::holds_alternative<scene::PlaneForm>(entry.form)) continue;
    const Vec3 normal = entry.rotation * Vec3::UnitY();
    const double sinking = -normal.dot(gravity);
    if (sinking <= kSteepest * gravity.norm()) continue;
    double way = std::numeric_limits<double>::max();
    for (const Vec3& corner : corners) way = std::min(way, normal.dot(corner - entry.position) / sinking);
    lands(way);
  }
  for (const geometry::Box& below : scenery.upright) {
    geometry::Box passed = from;
    passed.high.y() = std::max(below.low.y(), from.high.y());
    if (geometry::overlaps(passed, below)) lands((below.low.y() - from.high.y()) / gravity.norm());
  }
  return nearest ? std::optional<Vec3>(*nearest * gravity) : std::nullopt;
}

// s, in which something with this velocity falls that way.
double fall_time(const Vec3& gravity, const Vec3& velocity, const Vec3& way) {
  const double g = gravity.norm(), speed = velocity.dot(gravity) / g;
  return (std::sqrt(speed * speed + 2.0 * g * way.norm()) - speed) / g;
}

// How far something with this velocity gets to the side while it falls that way.
Vec3 way_aside(const Vec3& gravity, const Vec3& velocity, const Vec3& way) {
  if (way.isZero(0.0)) return way;
  const Vec3 down = gravity.normalized();
  return fall_time(gravity, velocity, way) * (velocity - velocity.dot(down) * down);
}

// What fell that way, or stands, on the floor, with room to tip over, and around it for the pieces of what
// fell; where it is, if there is no floor.
Corners spread_out(const Corners& corners, const std::optional<Vec3>& way, const Vec3& gravity) {
  if (!way) return corners;
  const Vec3 down = gravity.normalized(), aside = down.unitOrthogonal(), across = down.cross(aside);
  Vec3 middle = *way;
  for (const Vec3& corner : corners) middle += corner / 8.0;
  const geometry::Box box = upright(corners, down);
  const Vec3 half = 0.5 * (box.high - box.low);
  const double far = std::min(way->norm() / (2.0 * half.maxCoeff()), 1.0);
  const double wider = 1.0 + (kRoomForPieces - 1.0) * far, to_tip = kRoomToTip * half.y();
  const Vec3 side = std::max(wider * half.x(), to_tip) * aside,
             depth = std::max(wider * half.z(), to_tip) * across;
  Corners room;
  for (std::size_t k = 0; k < room.size(); ++k)
    room[k] =
        middle + (k & 1 ? side : -side) + (k & 2 ? half.y() : -half.y()) * down + (k & 4 ? depth : -depth);
  return room;
}

void add_within(const geometry::Box& room, const Corners& corners, std::vector<Vec3>& points) {
  for (const Vec3& corner : corners) points.push_back(corner.cwiseMax(room.low).cwiseMin(room.high));
}

// Of others what is about the points, so that a cup on a long table is not lost on it; all of them if there
// are no points.
void add_about(const std::vector<Corners>& others, std::vector<Vec3>& points) {
  if (points.empty()) {
    for (const Corners& corners : others) append(corners, points);
    return;
  }
  const geometry::Box about = room_about(box_about(points), kRoomForScenery);
  for (const Corners& corners : others) {
    if (geometry::overlaps(box_about(corners), about)) add_within(about, corners, points);
  }
}

Vec3 middle_of(const std::vector<Vec3>& points) {
  const geometry::Box box = box_about(points);
  return 0.5 * (box.low + box.high);
}

// By how much from its own place the body comes into the world: not at all, or as events drop it.
std::vector<Vec3> find_entrances(const scene::SceneDescription& scene, std::size_t number) {
  const scene::BodyEntry& body = scene.bodies[number];
  if (!body.is_held_back) return {Vec3::Zero()};
  std::vector<Vec3> shifts;
  for (const scene::EventEntry& event : scene.events) {
    const auto* drop = std::get_if<scene::Drop>(&event.action);
    if (drop == nullptr || event.who.body != static_cast<int>(number)) continue;
    shifts.emplace_back(drop->position.value_or(body.position) - body.position);
  }
  return shifts;
}

// By how much from its own place hands carry a body whose centre is there, m.
std::vector<Vec3> find_carries(const scene::SceneDescription& scene, std::size_t number, const Vec3& centre) {
  std::vector<Vec3> shifts;
  Vec3 grip = centre;
  for (const scene::EventEntry& event : scene.events) {
    if (event.who.body != static_cast<int>(number)) continue;
    if (const auto* grab = std::get_if<scene::Grab>(&event.action)) grip = grab->point.value_or(centre);
    if (const auto* carry = std::get_if<scene::Carry>(&event.action)) shifts.emplace_back(carry->to - grip);
  }
  return shifts;
}

// Of each body whether joints hold it to something that does not fall.
std::vector<char> find_hung(const scene::SceneDescription& scene) {
  std::vector<char> is_hung(scene.bodies.size(), 0);
  const auto holds = [&](const scene::BodyRef& partner) {
    const auto number = static_cast<std::size_t>(partner.body);
    return is_hung[number] != 0 || scene.bodies[number].motion != body::Motion::dynamic;
  };
  for (bool is_settled = false; !is_settled;) {
    is_settled = true;
    for (const scene::JointEntry& joint : scene.joints) {
      if (std::none_of(joint.partners.begin(), joint.partners.end(), holds)) continue;
      for (const scene::BodyRef& partner : joint.partners) {
        if (holds(partner)) continue;
        is_hung[static_cast<std::size_t>(partner.body)] = 1;
        is_settled = false;
      }
    }
  }
  return is_hung;
}

// The fall of all that moves, if all that happens is that it falls and is thrown at: nothing follows a path,
// or comes in later.
std::optional<Fall> find_fall(const scene::SceneDescription& scene, const scene::ScenePlan& plan,
                              const Scenery& scenery, const std::vector<char>& is_hung) {
  Fall fall;
  fall.acceleration = scene.world.gravity.norm();
  if (!(fall.acceleration > 0.0)) return std::nullopt;
  const Vec3 down = scene.world.gravity / fall.acceleration;
  std::vector<Vec3> landed;  // without room for pieces
  bool moves = false;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const scene::BodyEntry& body = scene.bodies[i];
    if (body.path || body.repeat.every > 0.0) return std::nullopt;
    if (body.is_held_back && !find_entrances(scene, i).empty()) return std::nullopt;
    if (!find_carries(scene, i, body.position).empty()) return std::nullopt;
    if (body.is_held_back) continue;  // thrown
    if (plan.bodies[i].reach <= 0.0 || is_scenery(body)) continue;
    const bool is_falling = can_fall(body, is_hung[i] != 0);
    const double speed = body.velocity.dot(down);
    if (is_falling && (speed < 0.0 || (body.velocity - speed * down).norm() > kSideways)) return std::nullopt;
    for (const Pose& pose : scene::copy_poses(body, scene.world.seed, i)) {
      const Corners corners = corners_of(plan.bodies[i].box, pose);
      const auto way = is_falling ? way_down(scene, scenery, corners) : std::nullopt;
      append(corners, fall.from);
      append(spread_out(corners, way, scene.world.gravity), fall.to);
      for (const Vec3& corner : corners) landed.push_back(corner + way.value_or(Vec3::Zero()));
      if (!is_on_axle(body)) continue;
      for (auto* points : {&fall.from, &fall.to})
        append(corners_on_axle(body, plan.bodies[i], pose), *points);
    }
    if (!is_falling) continue;
    fall.speed = moves ? std::min(fall.speed, speed) : speed;
    moves = true;
  }
  if (!moves) return std::nullopt;
  for (std::vector<Vec3>* points : {&fall.from, &fall.to, &landed}) add_about(scenery.corners, *points);
  fall.way = (middle_of(landed) - middle_of(fall.from)).norm();
  return fall;
}

bool is_thrown(const scene::SceneDescription& scene, const scene::BodyEntry& body) {
  const Vec3& gravity = scene.world.gravity;
  const Vec3 along = gravity.isZero(0.0) ? Vec3(Vec3::Zero()) : Vec3(gravity.normalized());
  return (body.velocity - body.velocity.dot(along) * along).norm() > kSideways;
}

// About all that is there when something is thrown, if anything is; planes are everywhere.
std::vector<geometry::Box> find_targets(const scene::SceneDescription& scene, const scene::ScenePlan& plan) {
  std::vector<geometry::Box> targets;
  if (std::none_of(scene.bodies.begin(), scene.bodies.end(),
                   [&](const scene::BodyEntry& body) { return is_thrown(scene, body); }))
    return targets;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    if (plan.bodies[i].bounding_radius <= 0.0 || scene.bodies[i].is_held_back) continue;
    for (const Pose& pose : scene::copy_poses(scene.bodies[i], scene.world.seed, i))
      targets.push_back(box_about(corners_of(plan.bodies[i].box, pose)));
  }
  return targets;
}

// How far what is thrown flies until it comes upon something, before it lands; nothing if it is not thrown,
// or meets nothing.
std::optional<Vec3> find_target(const scene::SceneDescription& scene, const scene::BodyEntry& body,
                                const Corners& corners, const Vec3& way,
                                const std::vector<geometry::Box>& targets) {
  if (!is_thrown(scene, body)) return std::nullopt;
  const Vec3& gravity = scene.world.gravity;
  double seconds = scene.seconds;
  if (!way.isZero(0.0)) seconds = std::min(seconds, fall_time(gravity, body.velocity, way));
  return find_meeting(box_about(corners), body.velocity, gravity, targets, seconds);
}

}  // namespace

Subject find_subject(const scene::SceneDescription& scene, const scene::ScenePlan& plan) {
  Subject subject;
  const std::vector<char> is_hung = find_hung(scene);
  const Scenery scenery = find_scenery(scene, plan);
  const std::vector<geometry::Box> targets = find_targets(scene, plan);
  std::vector<Corners> thrown;  // and dropped upon others
  const bool has_target = std::any_of(scene.bodies.begin(), scene.bodies.end(), [](const auto& body) {
    return !body.is_held_back && !is_scenery(body) && !std::holds_alternative<scene::PlaneForm>(body.form);
  });
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const scene::BodyEntry& body = scene.bodies[i];
    const scene::BodyPlan& planned = plan.bodies[i];
    if (planned.bounding_radius <= 0.0 || is_scenery(body)) continue;
    for (const Vec3& shift : find_entrances(scene, i)) {
      for (const Pose& own : scene::copy_poses(body, scene.world.seed, i)) {
        const Pose pose{own.rotation, own.translation + shift};
        const Corners corners = corners_of(planned.box, pose);
        const bool flies = can_fall(body, is_hung[i] != 0);
        const auto way = flies ? way_down(scene, scenery, corners) : std::nullopt;
        const Vec3 down = way.value_or(Vec3::Zero());
        if (const auto met = flies ? find_target(scene, body, corners, down, targets) : std::nullopt) {
          Corners there = corners;
          for (Vec3& corner : there) corner += *met;
          append(there, subject.corners);
          append(spread_out(there, way_down(scene, scenery, there), scene.world.gravity), subject.corners);
          thrown.push_back(corners);
          continue;
        }
        if (body.is_held_back && has_target)
          thrown.push_back(corners);
        else
          append(corners, subject.corners);
        if (body.path) append(corners_on_path(body, planned, pose, scene.seconds), subject.corners);
        if (is_on_axle(body)) append(corners_on_axle(body, planned, pose), subject.corners);
        for (const Vec3& carried : find_carries(scene, i, pose.apply(planned.centre))) {
          const Corners there = corners_of(planned.box, {pose.rotation, pose.translation + carried});
          append(there, subject.corners);
          append(spread_out(there, way_down(scene, scenery, there), scene.world.gravity), subject.corners);
        }
        const Vec3 aside = way_aside(scene.world.gravity, body.velocity, down);
        for (const Vec3& corner : spread_out(corners, way, scene.world.gravity))
          subject.corners.push_back(corner + aside);
      }
    }
  }
  for (const scene::JointEntry& joint : scene.joints)
    if (const auto* pivot = std::get_if<world::PivotDescription>(&joint.form); pivot && !joint.is_chain)
      subject.corners.push_back(pivot->point);
  // They come in from where there is still room.
  const geometry::Box room = room_about(box_about(subject.corners), kRoomToComeIn);
  for (const Corners& corners : thrown) add_within(room, corners, subject.corners);
  add_about(scenery.corners, subject.corners);
  if (subject.corners.empty())
    append(corners_of({Vec3::Constant(-1.0), Vec3::Constant(1.0)}, Pose()), subject.corners);
  subject.centre = middle_of(subject.corners);
  subject.fall = find_fall(scene, plan, scenery, is_hung);
  if (subject.fall) {
    const Framing framing{scene.camera.up, scene.camera.fov, std::nullopt};
    const auto distance = [&](const std::vector<Vec3>& corners) {
      const Viewpoint view = frame_points(corners, framing);
      return (view.position - view.target).norm();
    };
    const double closest = std::max(distance(subject.fall->from), distance(subject.fall->to));
    if (distance(subject.corners) < kWorthGoing * closest) subject.fall.reset();
  }
  return subject;
}

}  // namespace shatterbox::sandbox::view
