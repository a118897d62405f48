#include "sandbox/script/script.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "engine/core/elementary.h"
#include "engine/dynamics/line_of_sight.h"
#include "sandbox/scene/parts.h"
#include "sandbox/script/room.h"

namespace shatterbox::sandbox::script {

namespace {

/// An impulse at a point goes to the part whose bounding ball is nearest to it; one without a point is shared
/// by mass. A sentence if there is nothing to push.
std::string push_bodies(const scene::Push& push, scene::BodyRef who, scene::BuiltScene& built) {
  struct Share {
    body::BodyId id;
    Vec3 impulse, point;
  };
  std::vector<Share> shares;
  double total = 0.0, least = 1e300;
  const std::vector<const body::Body*> parts = scene::parts_of(built, built.world.bodies(), who);
  for (const body::Body* part : parts) total += part->shape->mass;
  for (const body::Body* part : parts) {
    const Vec3& centre = part->pose.translation;
    if (!push.point) {
      shares.push_back({part->id, push.impulse * (part->shape->mass / total), centre});
      continue;
    }
    const double distance = (*push.point - centre).norm() - part->shape->bounding_radius;
    if (distance >= least) continue;
    least = distance;
    shares = {{part->id, push.impulse, *push.point}};
  }
  if (shares.empty()) return "its body is not there";
  bool is_felt = false;
  for (const Share& share : shares)
    is_felt = built.world.push_body(share.id, share.impulse, share.point) || is_felt;
  return is_felt ? "" : "its body cannot move, or would be quicker than 1e9 m/s";
}

/// A sentence if there is nothing to remove.
std::string remove_bodies(scene::BodyRef who, scene::BuiltScene& built) {
  std::vector<body::BodyId> ids;
  for (const body::Body* part : scene::parts_of(built, built.world.bodies(), who)) ids.push_back(part->id);
  for (const body::BodyId id : ids) built.world.remove_body(id);
  return ids.empty() ? "its body is not there" : "";
}

/// When an event that is played now was due, s: as the scene says it, if it says a time.
double time_of(const scene::EventEntry& event, const scene::BuiltScene& built) {
  return event.when == scene::When::time ? event.at : built.world.time();
}

/// What the camera sees at a place of its picture; where nothing is, as far away as it looks.
Vec3 seen_at(const scene::ScreenPlace& place, const Sight& sight, const world::World& world) {
  constexpr double kFar = 100.0;  // times as far as it looks
  const Vec3 there = sight.target + place.right * sight.right + place.up * sight.up;
  const Vec3 far = sight.eye + kFar * (there - sight.eye);
  const auto share = dynamics::LineOfSight(world.bodies()).first_hit(sight.eye, far);
  return share ? Vec3(sight.eye + *share * (far - sight.eye)) : there;
}

/// s, of a flight along `way` (m) with that speed; the quicker of two, nothing where it does not reach so
/// far.
std::optional<double> flight_time(const Vec3& way, double speed, const Vec3& gravity) {
  // |way - g t2/2| = speed t is quadratic in t2 = t^2.
  const double a = 0.25 * gravity.squaredNorm();
  const double b = way.dot(gravity) + speed * speed;
  const double c = way.squaredNorm();
  const double discriminant = b * b - 4.0 * a * c;
  if (discriminant < 0.0 || b <= 0.0) return std::nullopt;
  return core::sqrt(2.0 * c / (b + core::sqrt(discriminant)));  // the lesser root, without cancellation
}

/// What goes up or down faster than rest lets it falls.
MovingTarget moving_target(const scene::BuiltScene& built, scene::BodyRef who, const Vec3& centre) {
  constexpr double kFalling = 0.1;  // s of free fall: so fast nothing settles
  const Vec3& gravity = built.world.settings().gravity;
  const Vec3 velocity = scene::velocity_of(built, built.world.bodies(), who);
  const bool is_falling = std::abs(velocity.dot(gravity)) > kFalling * gravity.squaredNorm();
  return {centre, velocity, is_falling};
}

/// What an event brings in, and how long it flies to its target, s.
struct Coming {
  world::BodyDescription description;
  double flight = 0.0;
};

/// With its motion; or a sentence why it cannot be.
core::Result<Coming> describe(const scene::EventEntry& event, const scene::BuiltScene& built,
                              const std::function<Sight()>& look, std::vector<std::string>& faults) {
  world::BodyDescription description =
      built.plan.bodies[static_cast<std::size_t>(event.who.body)].description;
  if (const auto* drop = std::get_if<scene::Drop>(&event.action)) {
    if (drop->position) description.pose.translation = *drop->position;
    return Coming{std::move(description)};
  }
  const auto& projectile = std::get<scene::Projectile>(event.action);
  std::optional<Sight> sight;
  const bool is_from_camera = !projectile.from.has_value();
  if (const auto* place = std::get_if<scene::ScreenPlace>(&projectile.target); place || is_from_camera) {
    if (!look) return core::Error{"there is no camera"};
    sight = look();
  }
  const Vec3 from = is_from_camera ? sight->eye : *projectile.from;
  Vec3 target = Vec3::Zero();
  if (const auto* point = std::get_if<Vec3>(&projectile.target)) {
    target = *point;
  } else if (const auto* place = std::get_if<scene::ScreenPlace>(&projectile.target)) {
    target = seen_at(*place, *sight, built.world);
  } else {
    const auto centre =
        scene::centre_of(built, built.world.bodies(), std::get<scene::BodyRef>(projectile.target));
    if (!centre) return core::Error{"its target is not there"};
    target = lead(from, moving_target(built, std::get<scene::BodyRef>(projectile.target), *centre),
                  projectile.speed, built.world.settings().gravity);
  }
  const Vec3 way = target - from;
  const double distance = way.norm();
  if (distance < 1e-9) return core::Error{"its target is where it starts"};
  description.pose.translation = from;
  const auto velocity = aim(from, target, projectile.speed, built.world.settings().gravity);
  description.velocity = velocity.value_or(Vec3(way * (projectile.speed / distance)));
  if (!velocity) {
    faults.push_back(fmt::format(
        "event \"{}\" at {:g} s: at {:g} m/s it cannot reach its target {:.3g} m away; thrown straight at it",
        event.name, time_of(event, built), projectile.speed, distance));
  }
  description.angular_velocity = projectile.spin;
  const auto flight = flight_time(way, projectile.speed, built.world.settings().gravity);
  return Coming{std::move(description), flight.value_or(distance / projectile.speed)};
}

/// The first step border at or after `seconds`. A hair's breadth of tolerance: 0.1 s is step 24 of 240,
/// although 0.1 * 240 is not 24 to the bit.
long step_of(double seconds, double rate) {
  return static_cast<long>(std::ceil(seconds * rate - 1e-6));
}

}  // namespace

Script::Script(const scene::SceneDescription& scene)
    : scene_(scene), coming_(scene.events.size()), throws_(scene.bodies.size(), 0) {
  std::iota(coming_.begin(), coming_.end(), std::size_t{0});
  for (std::size_t entry = 0; entry < scene.bodies.size(); ++entry) {
    const scene::BodyEntry& body = scene.bodies[entry];
    if (body.repeat.every <= 0.0 || body.is_held_back) continue;
    const std::vector<Pose> poses = scene::copy_poses(body, scene.world.seed, entry);
    for (std::size_t copy = 1; copy < poses.size(); ++copy) {
      const long due = step_of(static_cast<double>(copy) * body.repeat.every, scene.world.steps_per_second);
      copies_.push_back({due, static_cast<int>(entry), static_cast<int>(copy), poses[copy]});
    }
  }
  std::stable_sort(copies_.begin(), copies_.end(),
                   [](const LateCopy& a, const LateCopy& b) { return a.due < b.due; });
}

void Script::drop_copies(const scene::EventEntry& event, const scene::BuiltScene& built) {
  const auto entry = static_cast<std::size_t>(event.who.body);
  const scene::BodyEntry& body = scene_.bodies[entry];
  const auto& drop = std::get<scene::Drop>(event.action);
  const Vec3 shift = drop.position.value_or(body.position) - body.position;
  std::vector<Pose> poses = scene::copy_poses(body, scene_.world.seed, entry);
  const int before = throws_[entry];
  throws_[entry] += static_cast<int>(poses.size());
  for (std::size_t copy = 0; copy < poses.size(); ++copy) {
    poses[copy].translation += shift;
    const long after = step_of(static_cast<double>(copy) * body.repeat.every, scene_.world.steps_per_second);
    copies_.push_back(
        {built.world.steps() + after, event.who.body, before + static_cast<int>(copy), poses[copy]});
  }
  std::stable_sort(copies_.begin() + static_cast<std::ptrdiff_t>(next_copy_), copies_.end(),
                   [](const LateCopy& a, const LateCopy& b) { return a.due < b.due; });
}

std::string Script::bring_in(const scene::EventEntry& event, scene::BuiltScene& built, const Look& sight,
                             std::vector<std::string>& faults) {
  const scene::BodyEntry& entry = scene_.bodies[static_cast<std::size_t>(event.who.body)];
  if (std::holds_alternative<scene::Drop>(event.action) && entry.repeat.total() > 1) {
    drop_copies(event, built);
    return {};
  }
  auto coming = describe(event, built, sight, faults);
  if (!coming) return coming.error();
  auto& [description, flight] = coming.value();
  if (const std::string obstacle = find_obstacle(built.world, description); !obstacle.empty())
    return fmt::format("{} is where its body would come in", obstacle);
  const int count = ++throws_[static_cast<std::size_t>(event.who.body)];
  if (count > 1) description.name += fmt::format("[{}]", count);
  const auto id = built.world.add_body(description);
  if (!id) return id.error();
  built.origins[id.value()] = {event.who.body, count - 1};
  if (std::holds_alternative<scene::Projectile>(event.action))
    thrown_.push_back({id.value(), &event, built.world.time() + flight});
  return {};
}

std::vector<std::size_t> Script::take_due(const scene::BuiltScene& built) {
  conditions_.look(built);
  const world::World& world = built.world;
  std::vector<std::pair<long, std::size_t>> due;
  std::erase_if(coming_, [&](std::size_t number) {
    const scene::EventEntry& event = scene_.events[number];
    const auto since = conditions_.since(event);
    if (!since) return false;
    const long step = *since + step_of(event.at, world.settings().steps_per_second);
    if (step <= world.steps()) due.emplace_back(step, number);
    return step <= world.steps();
  });
  std::sort(due.begin(), due.end());
  std::vector<std::size_t> numbers;
  for (const auto& [step, number] : due) numbers.push_back(number);
  return numbers;
}

std::string Script::play_event(const scene::EventEntry& event, scene::BuiltScene& built, const Look& sight,
                               std::vector<std::string>& faults) {
  if (const auto* push = std::get_if<scene::Push>(&event.action)) return push_bodies(*push, event.who, built);
  if (std::holds_alternative<scene::Remove>(event.action)) return remove_bodies(event.who, built);
  if (const auto* gravity = std::get_if<scene::Gravity>(&event.action)) {
    forces_.change(*gravity, built.world);
    return {};
  }
  if (const auto* blast = std::get_if<scene::Explosion>(&event.action)) {
    built.world.explode({blast->centre, blast->energy, blast->duration});
    return {};
  }
  if (const auto* grab = std::get_if<scene::Grab>(&event.action))
    return forces_.grab(*grab, event.who, built);
  if (const auto* carry = std::get_if<scene::Carry>(&event.action))
    return forces_.carry(*carry, event.who, built);
  if (std::holds_alternative<scene::Release>(event.action)) return forces_.release(event.who, built);
  if (const auto* speed = std::get_if<scene::Speed>(&event.action)) {
    clock_.change(clock_.film_at(built.world.time()), speed->factor, speed->ramp);
    return {};
  }
  if (scene::is_for_picture(event)) {
    cues_.push_back({clock_.film_at(built.world.time()), &event});
    return {};
  }
  return bring_in(event, built, sight, faults);
}

void Script::play_events(scene::BuiltScene& built, const Look& sight, std::vector<std::string>& faults) {
  for (const std::size_t number : take_due(built)) {
    const scene::EventEntry& event = scene_.events[number];
    const std::string fault = play_event(event, built, sight, faults);
    if (!fault.empty())
      faults.push_back(
          fmt::format("event \"{}\" at {:g} s did nothing: {}", event.name, time_of(event, built), fault));
  }
}

bool Script::is_over() const {
  return coming_.empty() && next_copy_ == copies_.size() && waiting_.empty();
}

bool Script::may_change_speed() const {
  return std::any_of(coming_.begin(), coming_.end(), [this](std::size_t number) {
    return std::holds_alternative<scene::Speed>(scene_.events[number].action);
  });
}

void Script::bring_copies(scene::BuiltScene& built, std::vector<std::string>& faults) {
  for (; next_copy_ < copies_.size() && copies_[next_copy_].due <= built.world.steps(); ++next_copy_)
    waiting_.push_back(copies_[next_copy_]);
  std::vector<LateCopy> still_waiting;
  for (LateCopy& late : waiting_) {
    const auto entry = static_cast<std::size_t>(late.entry);
    world::BodyDescription description = built.plan.bodies[entry].description;
    description.name = scene::copy_name(scene_.bodies[entry], late.copy);
    description.pose = late.pose;
    if (const std::string obstacle = find_obstacle(built.world, description); !obstacle.empty()) {
      if (!late.was_told)
        faults.push_back(fmt::format("{} waits at {:g} s: {} is where it would come in", description.name,
                                     built.world.time(), obstacle));
      late.was_told = true;
      still_waiting.push_back(late);
      continue;
    }
    const auto id = built.world.add_body(description);
    if (id) {
      built.origins[id.value()] = {late.entry, late.copy};
    } else {
      faults.push_back(fmt::format("{} could not come in: {}", description.name, id.error()));
    }
  }
  waiting_ = std::move(still_waiting);
}

std::vector<std::string> Script::play(scene::BuiltScene& built, const Look& sight) {
  std::vector<std::string> faults;
  bring_copies(built, faults);
  play_events(built, sight, faults);
  bring_copies(built, faults);  // what the events let fall
  forces_.advance(built.world);
  return faults;
}

std::optional<Vec3> aim(const Vec3& from, const Vec3& target, double speed, const Vec3& gravity) {
  const Vec3 way = target - from;
  const auto time = flight_time(way, speed, gravity);
  if (!time) return std::nullopt;
  return Vec3((way - 0.5 * *time * *time * gravity) / *time);
}

Vec3 lead(const Vec3& from, const MovingTarget& target, double speed, const Vec3& gravity) {
  constexpr int kRounds = 100;
  Vec3 place = target.place;
  for (int round = 0; round < kRounds; ++round) {
    const auto time = flight_time(place - from, speed, gravity);
    if (!time) break;
    Vec3 next = target.place + *time * target.velocity;
    if (target.is_falling) next += 0.5 * *time * *time * gravity;
    if ((next - place).norm() < 1e-9 * (1.0 + (place - from).norm())) return next;
    place = next;
  }
  return target.place;
}

}  // namespace shatterbox::sandbox::script
