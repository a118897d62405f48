#include "sandbox/run/doubts.h"

#include <algorithm>
#include <map>
#include <set>
#include <span>

#include <fmt/format.h>

#include "engine/body/polyhedron.h"
#include "engine/core/elementary.h"
#include "engine/geometry/bvh.h"
#include "engine/material/tempering.h"
#include "engine/world/forms.h"
#include "sandbox/scene/build_mesh.h"
#include "sandbox/scene/parts.h"
#include "sandbox/script/room.h"
#include "sandbox/script/script.h"
#include "sandbox/view/camera_rig.h"
#include "sandbox/view/view.h"

namespace shatterbox::sandbox::run {

namespace {

using body::Body;
using body::ShapeKind;

constexpr double kThick = 0.25;          // of the greatest extent: a shell that is thicker hardly is one
constexpr long kMostTriangles = 300000;  // of the pairs that are looked at: a fraction of a second
constexpr std::size_t kMostTold = 5;     // pairs

const scene::BodyEntry& entry_of(const scene::SceneDescription& scene, const scene::BuiltScene& built,
                                 const Body& body) {
  return scene.bodies[static_cast<std::size_t>(built.origins.at(body.id).entry)];
}

void doubt_thickness(const scene::SceneDescription& scene, const scene::BuiltScene& built,
                     scene::Problems& doubts) {
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const auto* shell = std::get_if<world::ShellDescription>(&built.plan.bodies[i].description.form);
    if (shell == nullptr) continue;
    const geometry::Box box = geometry::box_of(shell->mesh);
    const double across = (box.high - box.low).maxCoeff();
    if (shell->thickness <= kThick * across) continue;
    scene::book(doubts, scene.bodies[i].place,
                fmt::format("the shell \"{}\" is {:.3g} m thick, and {:.3g} m across", scene.bodies[i].name,
                            shell->thickness, across),
                "thickness is in metres, 2 mm are 0.002; what is thick throughout is kind = \"solid\"");
  }
}

/// Sheets from files of so few triangles that they hardly bend: their stress is told far too low.
void doubt_triangles(const scene::SceneDescription& scene, const scene::BuiltScene& built,
                     scene::Problems& doubts) {
  constexpr std::size_t kFewTriangles = 500;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const scene::BodyEntry& entry = scene.bodies[i];
    const scene::MeshForm* form = scene::find_mesh_form(entry.form);
    const auto* shell = std::get_if<world::ShellDescription>(&built.plan.bodies[i].description.form);
    if (form == nullptr || shell == nullptr || !scene::can_break(entry)) continue;
    if (!std::holds_alternative<scene::MeshFileShape>(form->shape)) continue;
    if (shell->mesh.triangles.size() >= kFewTriangles) continue;
    scene::book(doubts, entry.place,
                fmt::format("\"{}\" has {} triangles: so few hardly bend, and its stress is told too low",
                            entry.name, shell->mesh.triangles.size()),
                fmt::format("edge_length = {:.2g} divides them into some thousands",
                            scene::usual_edge_length(shell->mesh)));
  }
}

/// Things of a household that are as large as a house: their sizes were hardly meant in metres.
void doubt_sizes(const scene::SceneDescription& scene, const scene::BuiltScene& built,
                 scene::Problems& doubts) {
  constexpr double kOfHouse = 5.0;  // m
  const auto is_of_household = [](const scene::MeshShape& shape) {
    return !std::holds_alternative<scene::MeshFileShape>(shape) &&
           !std::holds_alternative<scene::PaneShape>(shape) &&
           !std::holds_alternative<scene::SlabShape>(shape) &&
           !std::holds_alternative<scene::FigureShape>(shape) &&
           !std::holds_alternative<geometry::BoatSizes>(shape);
  };
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const scene::BodyEntry& entry = scene.bodies[i];
    const scene::MeshForm* form = scene::find_mesh_form(entry.form);
    const double across = 2.0 * built.plan.bodies[i].bounding_radius;
    if (form == nullptr || across < kOfHouse || !scene::can_break(entry) || !is_of_household(form->shape))
      continue;
    scene::book(doubts, entry.place, fmt::format("\"{}\" is {:.3g} m across", entry.name, across),
                "sizes are in metres: 30 cm are 0.3");
  }
}

/// Properties in other units than those of the SI: of anything that is solid they are far greater.
void doubt_materials(const scene::SceneDescription& scene, scene::Problems& doubts) {
  constexpr double kLeastStrength = 1e4, kLeastYoung = 1e6, kLeastDensity = 5.0;
  for (const scene::MaterialEntry& entry : scene.materials) {
    const material::Material& m = entry.material;
    const auto doubt = [&](const char* what, double value, const char* unit, const char* hint) {
      scene::book(doubts, entry.place, fmt::format("\"{}\" has a {} of {:g} {}", m.name, what, value, unit),
                  hint);
    };
    if (m.strength > 0.0 && m.strength < kLeastStrength)
      doubt("strength", m.strength, "Pa", "strengths are in pascals: 50 MPa are 50e6");
    if (m.young > 0.0 && m.young < kLeastYoung)
      doubt("young", m.young, "Pa", "moduli are in pascals: 70 GPa are 70e9");
    if (m.density > 0.0 && m.density < kLeastDensity)
      doubt("density", m.density, "kg/m3", "densities are in kg/m3: 2.5 g/cm3 are 2500");
  }
}

/// Toughened glass that is so thin that what is stored in it does not break it into dice.
void doubt_tempering(const scene::SceneDescription& scene, const scene::BuiltScene& built,
                     scene::Problems& doubts) {
  constexpr double kStep = 1e6, kMost = 3e8;  // Pa
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const scene::BodyEntry& entry = scene.bodies[i];
    const auto* shell = std::get_if<world::ShellDescription>(&built.plan.bodies[i].description.form);
    material::Material material = scene.materials[static_cast<std::size_t>(entry.material)].material;
    if (shell == nullptr || !scene::can_break(entry) || !(material.surface_compression > 0.0)) continue;
    if (material::die_area(material, shell->thickness) > 0.0) continue;
    do material.surface_compression += kStep;
    while (material.surface_compression < kMost && !(material::die_area(material, shell->thickness) > 0.0));
    scene::book(
        doubts, entry.place,
        fmt::format("\"{}\" stores too little for dice: {:g} mm of {} break into large pieces", entry.name,
                    1e3 * shell->thickness, material.name),
        fmt::format("make it thicker, or its surface_compression {:.3g} Pa", material.surface_compression));
  }
}

/// What is to break, by its material, and cannot by its kind; where anything else moves, it may be the
/// thrower's choice. Told once.
void doubt_kinds(const scene::SceneDescription& scene, scene::Problems& doubts) {
  const auto moves = [](const scene::BodyEntry& body) { return body.motion == body::Motion::dynamic; };
  const auto name_of_kind = [](const scene::BodyEntry& body) {
    if (std::holds_alternative<scene::BoxForm>(body.form)) return "box";
    if (std::holds_alternative<scene::CapsuleForm>(body.form)) return "capsule";
    return std::holds_alternative<scene::SphereForm>(body.form) ? "sphere" : "";
  };
  const auto is_doubtful = [&](const scene::BodyEntry& body) {
    const std::string& material = scene.materials[static_cast<std::size_t>(body.material)].preset;
    return name_of_kind(body)[0] != '\0' && material.find("glass") != std::string::npos;
  };
  const auto first = std::find_if(scene.bodies.begin(), scene.bodies.end(), moves);
  if (first == scene.bodies.end() ||
      !std::all_of(scene.bodies.begin(), scene.bodies.end(),
                   [&](const scene::BodyEntry& body) { return !moves(body) || is_doubtful(body); }))
    return;
  const bool is_box = std::holds_alternative<scene::BoxForm>(first->form);
  scene::book(doubts, first->place,
              fmt::format("\"{}\" is a {} of {}, which never breaks", first->name, name_of_kind(*first),
                          scene.materials[static_cast<std::size_t>(first->material)].preset),
              is_box ? "what breaks is kind = \"solid\" with shape = \"slab\" and a size, or kind = \"shell\""
                     : "what breaks is kind = \"solid\" or kind = \"shell\" with shape = \"sphere\"");
}

/// Paths that go as fast as a shot, and strike as hard.
void doubt_paths(const scene::SceneDescription& scene, scene::Problems& doubts) {
  constexpr double kShot = 100.0;  // m/s
  for (const scene::BodyEntry& body : scene.bodies) {
    if (!body.path) continue;
    const std::vector<body::Keyframe>& keys = body.path->keys;
    const auto speed_to = [&](std::size_t k) {
      return (keys[k].position - keys[k - 1].position).norm() / (keys[k].time - keys[k - 1].time);
    };
    for (std::size_t k = 1; k < keys.size(); ++k) {
      if (speed_to(k) <= kShot) continue;
      scene::book(doubts, body.place,
                  fmt::format("\"{}\" goes to its keyframe at {:g} s at {:.0f} m/s, which drives what is in "
                              "its way as fast",
                              body.name, keys[k].time, speed_to(k)),
                  "give it more time; what is to hit that hard is thrown: do = \"projectile\"");
      break;
    }
  }
}

/// Told once: of the first body that would be dented.
void doubt_criterion(const scene::SceneDescription& scene, const scene::BuiltScene& built,
                     scene::Problems& doubts) {
  if (scene.world.criterion != world::Criterion::paper) return;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const scene::BodyEntry& body = scene.bodies[i];
    const material::Material& material = scene.materials[static_cast<std::size_t>(body.material)].material;
    const auto& form = built.plan.bodies[i].description.form;
    const bool is_mesh = std::holds_alternative<world::SolidDescription>(form) ||
                         std::holds_alternative<world::ShellDescription>(form);
    if (!is_mesh || !(material.yield > 0.0)) continue;
    scene::book(
        doubts, body.place,
        fmt::format(
            "\"{}\" is of \"{}\", which yields, but criterion = \"paper\" knows neither dents nor holes",
            body.name, material.name),
        "it holds or breaks as if brittle; criterion = \"event\", the usual one, dents and perforates it");
    return;
  }
}

/// Bodies whose bounding balls meet, and of which one at least can move; planes meet everything.
std::vector<std::pair<const Body*, const Body*>> near_pairs(std::span<const Body> bodies) {
  std::vector<const Body*> planes, others;
  for (const Body& body : bodies) (body.shape->kind == ShapeKind::plane ? planes : others).push_back(&body);
  const auto low = [](const Body* b) { return b->pose.translation.x() - b->shape->bounding_radius; };
  std::stable_sort(others.begin(), others.end(),
                   [&](const Body* a, const Body* b) { return low(a) < low(b); });
  std::vector<std::pair<const Body*, const Body*>> pairs;
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

void doubt_room(const scene::SceneDescription& scene, const scene::BuiltScene& built,
                scene::Problems& doubts) {
  struct Inside {
    const Body *a, *b;
    int others;  // copies of the same two
    bool are_same;
  };
  long triangles = 0;
  std::map<std::pair<std::string, std::string>, Inside> found;
  for (const auto& [a, b] : near_pairs(built.world.bodies())) {
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
void doubt_tables(const scene::SceneDescription& scene, const scene::BuiltScene& built,
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
  for (const auto& [a, b] : near_pairs(built.world.bodies()))
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
  view::CameraRig rig(camera, view::find_subject(scene, built.plan));
  const auto where = [&](scene::BodyRef who) { return scene::centre_of(built, built.world.bodies(), who); };
  if (camera.place.line > 0)  // else nobody has placed it
    look(rig.view_at({0.0, 0.0, 1.0, built.world.bodies()}, where).position, true, camera.place);
  for (const scene::CameraKey& key : camera.path)
    if (key.at > 0.0) look(key.position, false, camera.place);
  for (const scene::EventEntry& event : scene.events)
    if (const auto* change = std::get_if<scene::CameraChange>(&event.action); change && change->position)
      look(*change->position, false, event.place);
}

/// How far the flight passes from a body, m: below 0 if it may meet it. One that can move may have fallen by
/// then, as far as `floor` (m).
class Flight {
 public:
  Flight(const Vec3& from, const Vec3& velocity, const Vec3& gravity, double at, double seconds,
         double radius)
      : from_(from), velocity_(velocity), gravity_(gravity), at_(at), seconds_(seconds), radius_(radius) {}

  double distance(const Body& body, double floor) const {
    constexpr int kSamples = 2000;
    double nearest = 1e300;
    for (int i = 0; i <= kSamples; ++i) {
      const double time = seconds_ * i / kSamples, now = at_ + time;
      const Vec3 place = from_ + time * velocity_ + 0.5 * time * time * gravity_;
      const Vec3 speed = velocity_ + time * gravity_;
      double reach = body.shape->bounding_radius + radius_ + speed.norm() * seconds_ / kSamples;
      Vec3 offset = place - body.pose.translation;
      if (body.is_dynamic()) {
        // It may lie, fall, or roll a little where it fell to.
        reach += 2.0 * body.shape->bounding_radius + body.velocity.norm() * now;
        const double fallen = std::clamp(-offset.y(), 0.0, std::max(0.0, body.pose.translation.y() - floor));
        offset.y() += fallen;
      }
      nearest = std::min(nearest, offset.norm() - reach);
    }
    return nearest;
  }

 private:
  Vec3 from_, velocity_, gravity_;
  double at_, seconds_, radius_;
};

/// Where what is to be hit is can be told only where nothing but what stands there from the start is to be
/// hit.
bool can_foretell(const scene::SceneDescription& scene) {
  const Vec3& g = scene.world.gravity;
  if (g.y() > 0.0 || g.x() != 0.0 || g.z() != 0.0) return false;
  for (const scene::BodyEntry& body : scene.bodies)
    if (body.motion == body::Motion::scripted || body.repeat.every > 0.0) return false;
  return std::all_of(scene.events.begin(), scene.events.end(), [](const scene::EventEntry& event) {
    return std::holds_alternative<scene::Projectile>(event.action) || scene::is_for_picture(event) ||
           std::holds_alternative<scene::Speed>(event.action);
  });
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

void doubt_waiting(const scene::SceneDescription& scene, scene::Problems& doubts) {
  const bool can_any = std::any_of(scene.bodies.begin(), scene.bodies.end(), scene::can_break);
  for (const scene::EventEntry& event : scene.events) {
    if (event.when != scene::When::first_break) continue;
    const scene::BodyEntry* whose =
        event.whose.body < 0 ? nullptr : &scene.bodies[static_cast<std::size_t>(event.whose.body)];
    if (whose == nullptr ? can_any : scene::can_break(*whose)) continue;
    const std::string who =
        whose == nullptr ? "nothing here can break" : fmt::format("\"{}\" cannot break", whose->name);
    scene::book(doubts, event.place,
                fmt::format("event \"{}\" waits for the first break, and {}", event.name, who),
                "shells and solids can: kind = \"shell\" or \"solid\"; or give it a time, at = 0.5");
  }
}

/// What is moved or let go when no hand holds it. A hand whose time is not known may hold from the start.
void doubt_hands(const scene::SceneDescription& scene, scene::Problems& doubts) {
  std::set<scene::BodyRef> held;
  const auto is_grab = [](const scene::EventEntry& event) {
    return std::holds_alternative<scene::Grab>(event.action);
  };
  for (const scene::EventEntry& event : scene.events)
    if (is_grab(event) && event.when != scene::When::time) held.insert(event.who);
  for (const scene::EventEntry& event : scene.events) {
    const bool is_release = std::holds_alternative<scene::Release>(event.action);
    if (is_grab(event)) held.insert(event.who);
    if (!is_release && !std::holds_alternative<scene::Carry>(event.action)) continue;
    if (held.count(event.who) == 0) {
      const std::string& name = scene.bodies[static_cast<std::size_t>(event.who.body)].name;
      scene::book(
          doubts, event.place,
          fmt::format("event \"{}\" {} \"{}\", and no hand holds it then", event.name,
                      is_release ? "lets go of" : "moves", name),
          fmt::format("an event before it takes it: do = \"grab\", body = \"{}\"; what is to go a way "
                      "of its own has motion = \"scripted\"",
                      name));
    }
    if (is_release && event.when == scene::When::time) held.erase(event.who);
  }
}

void doubt_throws(const scene::SceneDescription& scene, const scene::BuiltScene& built,
                  scene::Problems& doubts) {
  if (!can_foretell(scene)) return;
  double floor = -1e300;
  for (const Body& body : built.world.bodies())
    if (view::is_drawn_as_ground(body)) floor = std::max(floor, body.pose.translation.y());
  for (const scene::EventEntry& event : scene.events) {
    const auto* thrown = std::get_if<scene::Projectile>(&event.action);
    const Vec3* target = thrown == nullptr ? nullptr : std::get_if<Vec3>(&thrown->target);
    if (target == nullptr || !thrown->from || event.when != scene::When::time) continue;
    if (event.at >= scene.seconds) continue;
    const Vec3 way = *target - *thrown->from;
    const Vec3 velocity = script::aim(*thrown->from, *target, thrown->speed, scene.world.gravity)
                              .value_or(Vec3(way.normalized() * thrown->speed));
    const Flight flight(*thrown->from, velocity, scene.world.gravity, event.at, scene.seconds - event.at,
                        built.plan.bodies[static_cast<std::size_t>(event.who.body)].bounding_radius);
    double nearest = 1e300;
    const Body* whom = nullptr;
    for (const Body& body : built.world.bodies()) {
      if (body.shape->kind == ShapeKind::plane) continue;
      const double distance = flight.distance(body, floor);
      if (distance < nearest) whom = &body;
      nearest = std::min(nearest, distance);
    }
    if (whom == nullptr || nearest <= 0.0) continue;
    scene::book(doubts, event.place,
                fmt::format("event \"{}\" throws past everything: {:.2g} m beside \"{}\" at the nearest",
                            event.name, nearest, whom->name),
                fmt::format("at_body = \"{}\" aims at it", whom->name));
  }
}

/// m, root of the area of a half-disc at a surface that an even stress (Pa) drives on.
double crack_length(const material::Material& material, double stress) {
  return 2.0 / core::kPi * material.young * material.fracture_energy / (stress * stress);
}

void doubt_coarse_solids(const scene::SceneDescription& scene, const scene::BuiltScene& built,
                         scene::Problems& doubts) {
  std::map<int, const world::ImpactRow*> held;  // by entry
  const world::WorldReport& report = built.world.report();
  std::set<int> cracked;  // the same
  for (const world::ImpactRow& row : report.impacts) {
    const auto origin = built.origins.find(row.id);  // none: a piece
    if (origin == built.origins.end()) continue;
    if (row.verdict.starts_with("cracked")) cracked.insert(origin->second.entry);
    if (row.ratio < 1.0 || row.verdict.find("no crack could start") == std::string::npos) continue;
    const world::ImpactRow*& hardest = held[origin->second.entry];
    if (hardest == nullptr || row.ratio > hardest->ratio) hardest = &row;
  }
  for (const world::BreakRow& row : report.breaks)
    if (const auto origin = built.origins.find(row.id); origin != built.origins.end())
      held.erase(origin->second.entry);
  for (const auto& [entry, row] : held) {
    if (cracked.count(entry) > 0) continue;
    const auto number = static_cast<std::size_t>(entry);
    const auto* solid = std::get_if<world::SolidDescription>(&built.plan.bodies[number].description.form);
    if (solid == nullptr) continue;
    const double size = world::element_size_of(*solid);
    const scene::BodyEntry& body = scene.bodies[number];
    const material::Material& material = scene.materials[static_cast<std::size_t>(body.material)].material;
    const double length = crack_length(material, row->stress);
    if (length > size) {
      scene::book(
          doubts, body.place,
          fmt::format(
              "\"{}\" held, stressed to {:.2g} of its strength: {} is so tough that a crack needs {:.2g} m "
              "of such stress to start",
              row->body, row->ratio, material.name, length),
          "it takes more load, or a material of less fracture_energy");
      continue;
    }
    scene::book(
        doubts, body.place,
        fmt::format("\"{}\" held, stressed to {:.2g} of its strength: in elements of {:.2g} m no crack "
                    "could start",
                    row->body, row->ratio, size),
        fmt::format("--set {}.element_size={:.2g} looks closer, and takes longer", body.name, 0.5 * size));
  }
}

/// Nothing stands, and nobody met anybody on the way down.
void doubt_bottomless(const scene::SceneDescription& scene, const scene::BuiltScene& built,
                      scene::Problems& doubts) {
  constexpr double kFast = 3.0;  // m/s: after half a metre
  const std::span<const Body> bodies = built.world.bodies();
  if (built.world.report().contact.most_contacts > 0 || scene.world.gravity.isZero(0.0) || bodies.empty() ||
      !std::all_of(bodies.begin(), bodies.end(), [](const Body& body) { return body.is_dynamic(); }))
    return;
  const Body& first = bodies.front();
  const double speed = first.velocity.dot(scene.world.gravity.normalized());
  const auto origin = built.origins.find(first.id);
  if (speed < kFast || origin == built.origins.end()) return;
  scene::book(
      doubts, scene.bodies[static_cast<std::size_t>(origin->second.entry)].place,
      fmt::format("nothing met anything: \"{}\" falls at {:.2g} m/s at the end, and there is no floor",
                  first.name, speed),
      "[[body]] with kind = \"plane\" is one; where nothing is to fall, [scene] has gravity = [0, 0, 0]");
}

}  // namespace

scene::Problems find_doubts(const scene::SceneDescription& scene, const scene::BuiltScene& built) {
  scene::Problems doubts;
  doubt_thickness(scene, built, doubts);
  doubt_triangles(scene, built, doubts);
  doubt_sizes(scene, built, doubts);
  doubt_materials(scene, doubts);
  doubt_kinds(scene, doubts);
  doubt_tempering(scene, built, doubts);
  doubt_paths(scene, doubts);
  doubt_criterion(scene, built, doubts);
  doubt_room(scene, built, doubts);
  doubt_tables(scene, built, doubts);
  doubt_camera(scene, built, doubts);
  doubt_joints(scene, built, doubts);
  doubt_waiting(scene, doubts);
  doubt_hands(scene, doubts);
  doubt_throws(scene, built, doubts);
  return doubts;
}

scene::Problems find_afterthoughts(const scene::SceneDescription& scene, const scene::BuiltScene& built) {
  scene::Problems doubts;
  doubt_coarse_solids(scene, built, doubts);
  doubt_bottomless(scene, built, doubts);
  return doubts;
}

}  // namespace shatterbox::sandbox::run
