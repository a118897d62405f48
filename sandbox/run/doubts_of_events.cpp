#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "sandbox/run/doubt_groups.h"
#include "sandbox/script/script.h"
#include "sandbox/view/view.h"

namespace shatterbox::sandbox::run {

namespace {

using body::Body;
using body::ShapeKind;

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

}  // namespace

void doubt_events(const scene::SceneDescription& scene, const scene::BuiltScene& built,
                  scene::Problems& doubts) {
  doubt_waiting(scene, doubts);
  doubt_hands(scene, doubts);
  doubt_throws(scene, built, doubts);
}

}  // namespace shatterbox::sandbox::run
