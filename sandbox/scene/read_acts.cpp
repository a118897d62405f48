#include "sandbox/scene/read_event.h"

#include <fmt/format.h>

#include "sandbox/scene/nearest_name.h"
#include "sandbox/scene/read_body.h"

namespace shatterbox::sandbox::scene {

namespace {

/// Nothing, with a problem, if it is missing or no such vector.
std::optional<Vec3> find_needed(TableReader& reader, const std::string& key, const Range& range,
                                const char* example) {
  const auto value = reader.vector(key, range);
  if (!reader.has(key))
    reader.add_problem(reader.table().place, fmt::format("{} has no \"{}\"", reader.what(), key),
                       fmt::format("add {} = {}", key, example));
  return value;
}

Vec3 read_needed(TableReader& reader, const std::string& key, const Range& range, const char* example) {
  return find_needed(reader, key, range, example).value_or(Vec3::Zero());
}

ScreenPlace read_screen_place(TableReader& reader, const TomlValue& value) {
  ScreenPlace place;
  const Range range = between(-2.0, 2.0);
  if (!value.is_array() || value.items.size() != 2) {
    reader.add_problem(value.place,
                       fmt::format("at_screen must be two numbers, but is {}", kind_in_words(value)),
                       "write [right, up]: from the middle, in heights of the picture");
    return place;
  }
  place.right = reader.as_number(value.items[0], "the first of at_screen", range).value_or(0.0);
  place.up = reader.as_number(value.items[1], "the second of at_screen", range).value_or(0.0);
  return place;
}

}  // namespace

int read_thrown_body(TableReader& reader, const std::string& event_name, bool has_default,
                     SceneDescription& scene) {
  const TomlValue* value = reader.value("body");
  if (value == nullptr && has_default) {
    BodyEntry ball;
    ball.place = reader.table().place;
    ball.name = event_name + " ball";
    ball.form = SphereForm{0.03};
    ball.material = find_material("steel", ball.place, scene, reader.problems());
    ball.is_held_back = true;
    scene.bodies.push_back(ball);
    return static_cast<int>(scene.bodies.size()) - 1;
  }
  if (value == nullptr) {
    reader.add_problem(reader.table().place, fmt::format("{} names no body", reader.what()),
                       "add body = \"name\" or body = {kind = \"sphere\", radius = 0.05}");
    return -1;
  }
  if (value->is_table()) {
    read_body(*value, event_name + " body", true, scene, reader.problems());
    return static_cast<int>(scene.bodies.size()) - 1;
  }
  if (!value->is_text()) {
    reader.add_problem(value->place,
                       fmt::format("body must be a name or a table, but is {}", kind_in_words(*value)));
    return -1;
  }
  const int found = find_body(scene, value->text);
  if (found < 0) {
    reader.add_problem(value->place, fmt::format("there is no body \"{}\"", value->text),
                       hint_for_name(value->text, body_names(scene), "bodies"));
    return -1;
  }
  BodyEntry& body = scene.bodies[static_cast<std::size_t>(found)];
  if (body.motion != body::Motion::dynamic) {
    reader.add_problem(value->place,
                       fmt::format("body \"{}\" is {} and cannot be thrown", value->text,
                                   body.motion == body::Motion::fixed ? "static" : "scripted"),
                       "give it motion = \"dynamic\"");
  }
  body.is_held_back = true;
  return found;
}

BodyRef read_named_body(TableReader& reader, const std::string& key, const SceneDescription& scene) {
  const TomlValue* value = reader.value(key);
  if (value == nullptr || !reader.text(key)) return {};
  return read_body_ref(reader, *value, scene).value_or(BodyRef{});
}

BodyRef read_acted_body(TableReader& reader, const SceneDescription& scene) {
  if (!reader.has("body"))
    reader.add_problem(reader.table().place, fmt::format("{} names no body", reader.what()),
                       "add body = \"name\"");
  return read_named_body(reader, "body", scene);
}

Push read_push(TableReader& reader, int body, const SceneDescription& scene) {
  Push push;
  const auto impulse = find_needed(reader, "impulse", between(-1e6, 1e6, "N s"), "[x, y, z] (N s)");
  push.impulse = impulse.value_or(Vec3::Zero());
  if (impulse && impulse->squaredNorm() == 0.0)
    reader.add_problem_at("impulse", "an impulse of nothing pushes nothing");
  push.point = reader.vector("point", coordinate());
  if (body >= 0 && scene.bodies[static_cast<std::size_t>(body)].motion != body::Motion::dynamic)
    reader.add_problem_at("body", "what is static or scripted cannot be pushed",
                          "give it motion = \"dynamic\"");
  // Beside the centre of mass it may turn.
  if (body >= 0 && impulse && impulse->squaredNorm() > 0.0 && !push.point &&
      scene.bodies[static_cast<std::size_t>(body)].locked.let_move(*impulse).isZero(0.0))
    reader.add_problem_at("body", "it is pushed along axes that are fixed",
                          "take the axis out of fixed, or push it another way");
  return push;
}

Projectile read_projectile(TableReader& reader, const SceneDescription& scene) {
  Projectile projectile;
  const TomlValue* screen = reader.value("at_screen");
  if (screen == nullptr || reader.has("from"))
    projectile.from = read_needed(reader, "from", coordinate(), "[x, y, z]: where it starts");
  if (const auto speed = reader.number("speed", between(1e-3, 1e4, "m/s"))) {
    projectile.speed = *speed;
  } else if (!reader.has("speed")) {
    reader.add_problem(reader.table().place, fmt::format("{} has no \"speed\"", reader.what()),
                       "add speed = 10 (m/s)");
  }
  projectile.spin = reader.vector("spin", between(-1e5, 1e5, "rad/s")).value_or(projectile.spin);
  const auto point = reader.vector("at_point", coordinate());
  const BodyRef whom = read_named_body(reader, "at_body", scene);
  const int targets = int{reader.has("at_point")} + int{reader.has("at_body")} + int{screen != nullptr};
  if (targets != 1) {
    reader.add_problem(reader.table().place, fmt::format("{} needs one target", reader.what()),
                       "give one of at_point = [x, y, z], at_body = \"name\" and at_screen = [right, up]");
  } else if (screen != nullptr) {
    projectile.target = read_screen_place(reader, *screen);
  } else if (reader.has("at_body")) {
    projectile.target = whom;
  } else if (point) {
    projectile.target = *point;
    if (projectile.from && (*point - *projectile.from).norm() < 1e-9) {
      reader.add_problem_at("at_point", "the target is where the projectile starts", "move from or at_point");
    }
  }
  return projectile;
}

Gravity read_gravity(TableReader& reader) {
  Gravity gravity;
  gravity.gravity = read_needed(reader, "gravity", between(-1e4, 1e4, "m/s2"), "[0, -1.62, 0] (m/s2)");
  gravity.ramp = reader.number("ramp", between(0.0, 1e6, "s")).value_or(gravity.ramp);
  return gravity;
}

Explosion read_explosion(TableReader& reader) {
  Explosion explosion;
  explosion.centre = read_needed(reader, "centre", coordinate(), "[x, y, z] (m)");
  if (const auto energy = reader.number("energy", between(1e-6, 1e12, "J"))) {
    explosion.energy = *energy;
  } else if (!reader.has("energy")) {
    reader.add_problem(reader.table().place, fmt::format("{} has no \"energy\"", reader.what()),
                       "add energy = 10000 (J): what 2.4 grams of TNT have");
  }
  explosion.duration = reader.number("duration", between(1e-7, 0.1, "s")).value_or(0.0);
  return explosion;
}

Grab read_grab(TableReader& reader, int body, const SceneDescription& scene) {
  Grab grab;
  grab.point = reader.vector("point", coordinate());
  grab.force = reader.number("force", between(1e-6, 1e9, "N"));
  if (body >= 0 && scene.bodies[static_cast<std::size_t>(body)].motion != body::Motion::dynamic)
    reader.add_problem_at("body", "what is static or scripted cannot be grabbed",
                          "give it motion = \"dynamic\"");
  return grab;
}

Carry read_carry(TableReader& reader) {
  Carry carry;
  carry.to = read_needed(reader, "to", coordinate(), "[x, y, z] (m): where the hand goes");
  carry.duration = reader.number("duration", between(1e-3, 1e6, "s")).value_or(carry.duration);
  return carry;
}

}  // namespace shatterbox::sandbox::scene
