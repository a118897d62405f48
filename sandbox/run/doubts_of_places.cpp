#include <algorithm>
#include <map>
#include <set>
#include <span>

#include <fmt/format.h>

#include "engine/body/polyhedron.h"
#include "engine/geometry/bvh.h"
#include "sandbox/run/doubt_groups.h"
#include "sandbox/scene/parts.h"
#include "sandbox/script/room.h"
#include "sandbox/view/camera_rig.h"
#include "sandbox/view/view.h"

namespace shatterbox::sandbox::run {

namespace {

using body::Body;
using body::ShapeKind;

constexpr long kMostTriangles = 300000;  // of the pairs that are looked at: a fraction of a second
constexpr std::size_t kMostTold = 5;     // pairs

/// Bodies whose bounding balls meet, and of which one at least can move; planes meet everything.
using Pairs = std::vector<std::pair<const Body*, const Body*>>;
Pairs near_pairs(std::span<const Body> bodies) {
  std::vector<const Body*> planes, others;
  for (const Body& body : bodies) (body.shape->kind == ShapeKind::plane ? planes : others).push_back(&body);
  const auto low = [](const Body* b) { return b->pose.translation.x() - b->shape->bounding_radius; };
  std::stable_sort(others.begin(), others.end(),
                   [&](const Body* a, const Body* b) { return low(a) < low(b); });
  Pairs pairs;
  for (std::size_t i = 0; i < others.size(); ++i) {
    const Body& a = *others[i];
    for (const Body* plane : planes)
      if (a.is_dynamic()) pairs.emplace_back(&a, plane);
    for (std::size_t j = i + 1; j < others.size(); ++j) {
      const Body& b = *others[j];
      if (low(&b) > a.pose.translation.x() + a.shape->bounding_radius) break;
      const double reach = a.shape->bounding_radius + b.shape->bounding_radius;
      const bool can_meet = (a.is_dynamic() || b.is_dynamic()) && a.collides_with(b);
      if (can_meet && (a.pose.translation - b.pose.translation).norm() < reach) pairs.emplace_back(&a, &b);
    }
  }
  return pairs;
}

/// The same thing in the same place: its surfaces nowhere cross.
bool are_twins(const Body& a, const Body& b) {
  const std::vector<Vec3>&own = a.shape->surface.positions, &other = b.shape->surface.positions;
  if (!body::is_mesh(a.shape->kind) || own.size() != other.size()) return false;
  const double rounding = 1e-9 * a.shape->bounding_radius;
  return std::equal(own.begin(), own.end(), other.begin(), [&](const Vec3& p, const Vec3& q) {
    return (a.pose.apply(p) - b.pose.apply(q)).norm() <= rounding;
  });
}

void doubt_room(const scene::SceneDescription& scene, const scene::BuiltScene& built, const Pairs& pairs,
                scene::Problems& doubts) {
  struct Inside {
    const Body *a, *b;
    int others;  // copies of the same two
    bool are_same;
  };
  long triangles = 0;
  std::map<std::pair<std::string, std::string>, Inside> found;
  for (const auto& [a, b] : pairs) {
    triangles += static_cast<long>(a->shape->surface.triangles.size() + b->shape->surface.triangles.size());
    if (triangles > kMostTriangles) break;
    const std::pair names(entry_of(scene, built, *a).name, entry_of(scene, built, *b).name);
    const auto known = found.find(names);
    if (known == found.end() && found.size() == kMostTold) continue;
    const bool are_same = are_twins(*a, *b);
    if (!are_same && !script::lie_in_each_other(*a, *b)) continue;
    if (known == found.end())
      found.emplace(names, Inside{a, b, 0, are_same});
    else
      ++known->second.others;
  }
  for (const auto& [names, inside] : found) {
    const scene::BodyEntry &own = entry_of(scene, built, *inside.a),
                           &other = entry_of(scene, built, *inside.b);
    const bool is_floor = inside.b->shape->kind == ShapeKind::plane;
    const scene::BodyEntry& later = own.place.line > other.place.line || is_floor ? own : other;
    const bool holds = !is_floor && inside.a->shape->bounding_radius > inside.b->shape->bounding_radius;
    const Body &inner = holds ? *inside.b : *inside.a, &outer = holds ? *inside.a : *inside.b;
    scene::book(
        doubts, later.place,
        fmt::format("\"{}\" begins {} {}\"{}\"{}", inner.name, inside.are_same ? "exactly in" : "inside",
                    is_floor ? "the plane " : "", outer.name,
                    inside.others == 0 ? ""
                                       : fmt::format(", and {} more such pair{}", inside.others,
                                                     inside.others > 1 ? "s" : "")),
        inside.are_same
            ? "the second is set aside by a hundred thousandth of its size: move one of them, or give "
              "copies more spacing"
            : "what is solid is brought out slowly, sheets pass each other: move one of them, or give "
              "copies more spacing");
  }
}

/// m, how far the upper stands above the lower, where both are one open sheet, upright alike, and one stands
/// in the other; 0 of others.
double height_in(const Body& upper, const Body& lower, const Vec3& down) {
  constexpr double kAside = 0.05;  // of the height between them
  constexpr double kTurned = 1e-6;
  const body::Shape& shape = *upper.shape;
  if (shape.kind != ShapeKind::shell || upper.shape != lower.shape || !(shape.thickness > 0.0)) return 0.0;
  if (!upper.is_dynamic() || upper.pose.rotation.angularDistance(lower.pose.rotation) > kTurned) return 0.0;
  const Vec3 apart = lower.pose.translation - upper.pose.translation;
  const double height = apart.dot(down);
  if (!(height > 0.0) || (apart - height * down).norm() > kAside * height) return 0.0;
  double top = 1e300, foot = -1e300;
  for (const Vec3& p : shape.surface.positions) {
    const double depth = (upper.pose.rotation * p).dot(down);
    top = std::min(top, depth);
    foot = std::max(foot, depth);
  }
  const auto& topology = shape.topology;
  for (std::size_t edge = 0; edge < topology.edges.size() && height < foot - top; ++edge)
    if (topology.is_boundary(static_cast<int>(edge))) return height;
  return 0.0;
}

/// Bowls in bowls: sheets have no thickness to each other, so one sinks into the next until they are one.
void doubt_nests(const scene::SceneDescription& scene, const scene::BuiltScene& built, const Pairs& pairs,
                 scene::Problems& doubts) {
  if (scene.world.gravity.isZero(0.0)) return;
  const Vec3 down = scene.world.gravity.normalized();
  std::set<int> told;  // entries
  for (const auto& [a, b] : pairs)
    for (const auto& [upper, lower] : {std::pair(a, b), std::pair(b, a)}) {
      const double height = height_in(*upper, *lower, down);
      if (height == 0.0 || !told.insert(built.origins.at(upper->id).entry).second) continue;
      scene::book(
          doubts, entry_of(scene, built, *upper).place,
          fmt::format("\"{}\" stands in \"{}\", {:.3g} mm above it, and settles into it: what meets a "
                      "shell meets a surface, whatever its thickness",
                      upper->name, lower->name, 1e3 * height),
          "what is stacked so is a solid: kind = \"solid\", shape = \"lathe\" with both faces in its "
          "profile");
    }
}

geometry::Box bounds_of(const Body& body) {
  if (body.shape->kind == ShapeKind::sphere) {
    const Vec3 reach = Vec3::Constant(body.shape->radius);
    return {body.pose.translation - reach, body.pose.translation + reach};
  }
  geometry::Box bounds;
  for (const Vec3& p : body::find_polyhedron(*body.shape).positions) bounds.include(body.pose.apply(p));
  return bounds;
}

bool lies_on(const Body& upper, const Body& lower) {
  constexpr double kAbove = 0.005, kBelow = 0.001;  // m
  const geometry::Box box = bounds_of(upper);
  if (lower.shape->kind == ShapeKind::plane) return box.low.y() - lower.pose.translation.y() < kAbove;
  if (upper.shape->kind == ShapeKind::plane) return false;
  const geometry::Box below = bounds_of(lower);
  const double gap = box.low.y() - below.high.y();
  return gap > -kBelow && gap < kAbove && box.low.x() < below.high.x() && below.low.x() < box.high.x() &&
         box.low.z() < below.high.z() && below.low.z() < box.high.z();
}

/// A box that carries something and lies on nothing: a table that was meant to stay where it is.
void doubt_tables(const scene::SceneDescription& scene, const scene::BuiltScene& built, const Pairs& pairs,
                  scene::Problems& doubts) {
  const Vec3& gravity = scene.world.gravity;
  const bool is_down = gravity.y() < 0.0 && gravity.x() == 0.0 && gravity.z() == 0.0;
  if (!is_down || !scene.joints.empty()) return;
  struct Table {
    const Body* body;
    const Body* load = nullptr;
    bool is_carried = false;
  };
  std::map<body::BodyId, Table> tables;
  for (const Body& body : built.world.bodies())
    if (body.shape->kind == ShapeKind::box && body.is_dynamic() && body.velocity.isZero(0.0))
      tables.emplace(body.id, Table{&body});
  if (tables.empty()) return;
  for (const auto& [a, b] : pairs)
    for (const auto& [body, other] : {std::pair(a, b), std::pair(b, a)}) {
      const auto found = tables.find(body->id);
      if (found == tables.end()) continue;
      Table& table = found->second;
      table.is_carried = table.is_carried || lies_on(*body, *other);
      if (!table.is_carried && other->is_dynamic() && (!table.load || other->id < table.load->id) &&
          lies_on(*other, *body))
        table.load = other;
    }
  for (const auto& [id, table] : tables) {
    if (table.is_carried || table.load == nullptr) continue;
    scene::book(doubts, entry_of(scene, built, *table.body).place,
                fmt::format("\"{}\" lies on nothing, and falls with \"{}\" on it", table.body->name,
                            table.load->name),
                "what is to stay where it is has motion = \"static\"");
    return;
  }
}

/// The camera's own places, and those that events cut or go to.
void doubt_camera(const scene::SceneDescription& scene, const scene::BuiltScene& built,
                  scene::Problems& doubts) {
  const auto look = [&](const Vec3& place, bool is_at_start, const scene::Place& where) {
    for (const Body& body : built.world.bodies()) {
      const scene::BodyEntry& entry = entry_of(scene, built, body);
      const bool is_room = body.shape->kind == ShapeKind::shell && !scene::can_break(entry);
      const bool is_wall = body.shape->kind == ShapeKind::plane && !view::is_drawn_as_ground(body);
      if (is_room || is_wall || entry.look.name == "hidden") continue;
      if (!is_at_start && (body.is_dynamic() || body.is_driven() || body.script.path)) continue;
      if (!script::holds(body, place)) continue;
      const bool is_floor = body.shape->kind == ShapeKind::plane;
      scene::book(
          doubts, where,
          fmt::format("the camera is {} \"{}\" at [{:.3g}, {:.3g}, {:.3g}]",
                      is_floor ? "below the floor" : "inside", body.name, place.x(), place.y(), place.z()),
          "move its position out of it, or leave position out: then everything is in view");
      return;
    }
  };
  const scene::CameraEntry& camera = scene.camera;
  if (camera.place.line > 0) {  // else nobody has placed it
    view::CameraRig rig(camera, view::find_subject(scene, built.plan));
    const auto where = [&](scene::BodyRef who) { return scene::centre_of(built, built.world.bodies(), who); };
    look(rig.view_at({0.0, 0.0, 1.0, built.world.bodies()}, where).position, true, camera.place);
  }
  for (const scene::CameraKey& key : camera.path)
    if (key.at > 0.0) look(key.position, false, camera.place);
  for (const scene::EventEntry& event : scene.events)
    if (const auto* change = std::get_if<scene::CameraChange>(&event.action); change && change->position)
      look(*change->position, false, event.place);
}

/// Bodies by the number of their entry.
using BodiesOf = std::map<int, std::vector<const Body*>>;

/// How far a point is from the nearest of the bodies that a joint's partner means.
struct Reach {
  double distance = 1e300;  // m, from its centre
  double radii = 1e300;     // the same, of the ball about it
};

Reach find_reach(const Vec3& point, const scene::BodyRef& partner, const scene::BuiltScene& built,
                 const BodiesOf& bodies_of) {
  Reach nearest;
  const auto bodies = bodies_of.find(partner.body);
  if (bodies == bodies_of.end()) return nearest;  // they come in later
  for (const Body* body : bodies->second) {
    const scene::Origin& origin = built.origins.at(body->id);
    if (!partner.includes(origin.entry, origin.copy)) continue;
    if (body->shape->kind == ShapeKind::plane) return {0.0, 0.0};
    const double distance = (body->pose.translation - point).norm();
    const double radii = distance / body->shape->bounding_radius;
    if (radii < nearest.radii) nearest = {distance, radii};
  }
  return nearest;
}

void doubt_joints(const scene::SceneDescription& scene, const scene::BuiltScene& built,
                  scene::Problems& doubts) {
  constexpr double kFar = 4.0;  // radii of either body
  if (scene.joints.empty()) return;
  BodiesOf bodies_of;
  for (const Body& body : built.world.bodies()) bodies_of[built.origins.at(body.id).entry].push_back(&body);
  for (const scene::JointEntry& joint : scene.joints) {
    const auto* pivot = std::get_if<world::PivotDescription>(&joint.form);
    if (pivot == nullptr || joint.is_chain || joint.partners.size() != 2) continue;
    const Reach first = find_reach(pivot->point, joint.partners[0], built, bodies_of),
                second = find_reach(pivot->point, joint.partners[1], built, bodies_of);
    const double radii = std::min(first.radii, second.radii);
    if (radii <= kFar || radii >= 1e300) continue;
    const auto name = [&](std::size_t k) {
      return scene.bodies[static_cast<std::size_t>(joint.partners[k].body)].name;
    };
    scene::book(doubts, joint.place,
                fmt::format("joint \"{}\" is far from both: {:.3g} m from \"{}\" and {:.3g} m from \"{}\"",
                            joint.name, first.distance, name(0), second.distance, name(1)),
                "at is a point of the world, mostly on one of them or between them");
  }
}

}  // namespace

void doubt_places(const scene::SceneDescription& scene, const scene::BuiltScene& built,
                  scene::Problems& doubts) {
  const Pairs pairs = near_pairs(built.world.bodies());
  doubt_room(scene, built, pairs, doubts);
  doubt_nests(scene, built, pairs, doubts);
  doubt_tables(scene, built, pairs, doubts);
  doubt_camera(scene, built, doubts);
  doubt_joints(scene, built, doubts);
}

}  // namespace shatterbox::sandbox::run
