#include "sandbox/scene/read_event.h"

#include <algorithm>

#include <fmt/format.h>

#include "sandbox/scene/nearest_name.h"
#include "sandbox/scene/overrides.h"
#include "sandbox/scene/read_body.h"

namespace shatterbox::sandbox::scene {

namespace {

struct VerbKeys {
  std::string verb;
  std::vector<std::string> keys;  // beside those of all events
};

const std::vector<VerbKeys> kVerbKeys{
    {"projectile", {"body", "from", "at_point", "at_body", "at_screen", "speed", "spin"}},
    {"drop", {"body", "position"}},
    {"push", {"body", "impulse", "point"}},
    {"remove", {"body"}},
    {"gravity", {"gravity", "ramp"}},
    {"explosion", {"centre", "energy", "duration"}},
    {"grab", {"body", "point", "force"}},
    {"move", {"body", "to", "duration"}},
    {"release", {"body"}},
    {"speed", {"factor", "ramp"}},
    {"camera", {"move", "position", "target", "fov", "angle", "body", "offset", "duration", "easing"}},
    {"overlay", {"show", "most"}},
    {"caption", {"text", "duration", "fade"}},
};

/// Keys of other verbs, called for after those of its own: the verbs that they are for are named.
void refuse_other_keys(TableReader& reader) {
  for (const VerbKeys& row : kVerbKeys) {
    for (const std::string& key : row.keys) {
      std::vector<std::string> verbs;
      for (const VerbKeys& other : kVerbKeys)
        if (std::find(other.keys.begin(), other.keys.end(), key) != other.keys.end())
          verbs.push_back(other.verb);
      reader.foreign({key}, fmt::format("it is for do = {}", quoted_list(verbs)));
    }
  }
}

void read_when(TableReader& reader, const SceneDescription& scene, EventEntry& event) {
  const auto at = reader.number("at", between(0.0, 1e6, "s"));
  const auto when = reader.choice("when", kWhenNames);
  const auto after = reader.number("after", between(0.0, 1e6, "s"));
  if (reader.has("at") && reader.has("when")) {
    reader.add_problem_at("when", fmt::format("{} has both a time and a condition", reader.what()),
                          "keep at = 0.5 (s), or when = \"rest\" with after = 0.5 (s)");
    return;
  }
  if (!reader.has("at") && !reader.has("when")) {
    reader.add_problem(reader.table().place, fmt::format("{} has no time", reader.what()),
                       "add at = 0.5 (s), or when = \"first break\" or \"rest\"");
  }
  if (reader.has("after") && !reader.has("when"))
    reader.add_problem_at("after", "a delay needs something to wait for",
                          "write at = 0.5 (s), or add when = \"first break\"");
  event.at = at.value_or(after.value_or(0.0));
  if (when) event.when = *when == "rest" ? When::rest : When::first_break;
  event.whose = read_named_body(reader, "of", scene);
  if (reader.has("of") && event.when != When::first_break)
    reader.add_problem_at("of", "it says whose break is waited for, and none is",
                          "add when = \"first break\"");
}

/// What is thrown is one body, which goes where it is thrown.
void check_projectile(TableReader& reader, const EventEntry& event, const SceneDescription& scene) {
  if (event.who.body < 0) return;
  const BodyEntry& body = scene.bodies[static_cast<std::size_t>(event.who.body)];
  if (body.repeat.total() > 1)
    reader.add_problem_at("body", "a projectile is one body, and this one has copies",
                          "remove its repeat, or let it fall by do = \"drop\"");
  const auto& thrown = std::get<Projectile>(event.action);
  const std::string hint = "take the axis out of fixed, or throw it another way";
  if (const Vec3* target = std::get_if<Vec3>(&thrown.target); target != nullptr && thrown.from) {
    const Vec3 way = *target - *thrown.from;
    if (body.locked.let_move(way) != way)
      reader.add_problem_at("body", "it is thrown along an axis that is fixed", hint);
  }
  if (body.locked.let_turn(thrown.spin) != thrown.spin)
    reader.add_problem_at("body", "it is thrown with a spin about an axis that is fixed", hint);
}

}  // namespace

void read_event(const TomlValue& table, std::size_t index, SceneDescription& scene, Problems& problems) {
  EventEntry event;
  event.name = name_or_number(table, "event", index);
  event.place = table.place;
  TableReader reader(table, fmt::format("event \"{}\"", event.name), problems);
  reader.text("name");
  read_when(reader, scene, event);
  const auto verb = reader.choice("do", kEventVerbs);
  if (!reader.has("do")) {
    reader.add_problem(table.place, fmt::format("{} does nothing", reader.what()),
                       fmt::format("add do = one of {}", quoted_list(kEventVerbs)));
  }
  if (!verb) return;
  if (*verb == "projectile") {
    event.who.body = read_thrown_body(reader, event.name, true, scene);
    event.action = read_projectile(reader, scene);
    check_projectile(reader, event, scene);
    reader.foreign({"position"}, "a projectile starts at \"from\"");
  } else if (*verb == "drop") {
    event.who.body = read_thrown_body(reader, event.name, false, scene);
    event.action = Drop{reader.vector("position", coordinate())};
    reader.foreign({"height", "from", "at_point"}, "what is dropped falls from \"position\", [x, y, z]");
  } else if (*verb == "push") {
    event.who = read_acted_body(reader, scene);
    event.action = read_push(reader, event.who.body, scene);
  } else if (*verb == "remove") {
    event.who = read_acted_body(reader, scene);
    event.action = Remove{};
  } else if (*verb == "gravity") {
    event.action = read_gravity(reader);
  } else if (*verb == "explosion") {
    event.action = read_explosion(reader);
  } else if (*verb == "grab") {
    event.who = read_acted_body(reader, scene);
    event.action = read_grab(reader, event.who.body, scene);
  } else if (*verb == "move") {
    event.who = read_acted_body(reader, scene);
    event.action = read_carry(reader);
  } else if (*verb == "release") {
    event.who = read_acted_body(reader, scene);
    event.action = Release{};
  } else if (*verb == "speed") {
    event.action = read_speed(reader);
  } else if (*verb == "camera") {
    event.action = read_camera_change(reader, scene, event.who);
  } else if (*verb == "overlay") {
    event.action = read_overlay_change(reader);
  } else if (*verb == "caption") {
    event.action = read_caption(reader);
  }
  refuse_other_keys(reader);
  reader.finish();
  scene.events.push_back(std::move(event));
}

}  // namespace shatterbox::sandbox::scene
