// What moves a body: nothing, physics, or a path of keyframes.
#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "engine/core/elementary.h"
#include "sandbox/scene/nearest_name.h"
#include "sandbox/scene/read_body.h"

namespace shatterbox::sandbox::scene {

namespace {

const Range kAngle = between(-360000.0, 360000.0, "degrees");
const std::vector<std::string> kPathKeys{"keyframes", "between_keys", "pivot"};

Quat turn(double degrees, const Vec3& axis) {
  const double half = degrees * core::kPi / 360.0;
  const Vec3 v = core::sin(half) * axis;
  return {core::cos(half), v.x(), v.y(), v.z()};
}

std::vector<body::Keyframe> read_keys(TableReader& reader, const TomlValue& path, const BodyEntry& body) {
  std::vector<body::Keyframe> keys;
  body::Keyframe key;
  key.time = -1.0;
  key.position = body.position;
  if (const TomlValue* rotation = reader.table().find("rotation"); rotation && rotation->is_array())
    key.angles = reader.vector("rotation", kAngle).value_or(Vec3::Zero()) * (core::kPi / 180.0);
  for (std::size_t i = 0; i < path.items.size(); ++i) {
    const std::string what = fmt::format("{} keyframe {}", reader.what(), i + 1);
    if (!path.items[i].is_table()) {
      reader.add_problem(path.items[i].place,
                         fmt::format("{} must be a table, but is {}", what, kind_in_words(path.items[i])),
                         "write {at = 1.5, position = [0, 1, 0], rotation = [0, 90, 0]}");
      continue;
    }
    TableReader key_reader(path.items[i], what, reader.problems());
    const auto at = key_reader.number("at", not_negative("s"));
    if (!key_reader.has("at"))
      key_reader.add_problem(path.items[i].place, "a keyframe needs a time", "add at = 1.5");
    if (at && *at <= key.time)
      key_reader.add_problem_at(
          "at",
          fmt::format("keyframes must go forward in time, but {:g} s comes after {:g} s", *at, key.time));
    key.time = at.value_or(key.time + 1.0);
    key.position = key_reader.vector("position", coordinate()).value_or(key.position);
    if (const auto angles = key_reader.vector("rotation", kAngle)) {
      key.angles = *angles * (core::kPi / 180.0);
      if (std::holds_alternative<PlaneForm>(body.form) && !keys.empty() && key.angles != keys[0].angles)
        key_reader.add_problem_at("rotation", "a plane cannot turn on its way", "take a wide box");
    }
    key_reader.finish();
    keys.push_back(key);
  }
  return keys;
}

void read_path(TableReader& reader, BodyEntry& body) {
  const std::string hint =
      "write keyframes = [{at = 0, position = [0, 1, 0]}, {at = 2, position = [0, 0, 0]}]";
  const TomlValue* path = reader.value("keyframes");
  if (path == nullptr) {
    reader.add_problem_at("motion", fmt::format("{} is scripted but has no keyframes", reader.what()), hint);
    return;
  }
  if (!path->is_array()) {
    reader.add_problem(path->place, fmt::format("keyframes must be a list, but is {}", kind_in_words(*path)),
                       hint);
    return;
  }
  if (path->items.size() < 2) {
    reader.add_problem(path->place,
                       fmt::format("a path needs at least two keyframes, but has {}", path->items.size()),
                       "a body that stays where it is has motion = \"static\"");
    return;
  }
  if (reader.has("orientation"))
    reader.add_problem_at("orientation", "a body with a path has angles, not an orientation",
                          "write rotation = [x, y, z] in degrees");
  PathEntry entry;
  entry.keys = read_keys(reader, *path, body);
  entry.between = reader.choice("between_keys", {"smooth", "straight"}).value_or("smooth") == "smooth"
                      ? body::Between::smooth
                      : body::Between::straight;
  entry.pivot = reader.vector("pivot", coordinate()).value_or(entry.pivot);
  if (entry.keys.empty()) return;
  body.position = entry.keys.front().position;
  body.rotation = turn_by(entry.keys.front().angles * (180.0 / core::kPi));
  body.path = std::move(entry);
}

void read_scripted(TableReader& reader, bool is_held, BodyEntry& body) {
  reader.foreign({"velocity", "angular_velocity"}, "the path says how fast it is");
  if (is_held)
    reader.add_problem_at("motion", "a body with a support is held by the world and cannot follow a path",
                          "remove motion or support");
  if (body.is_held_back)
    reader.add_problem_at("motion", "a scripted body is there from the start; events cannot bring it in",
                          "let its first keyframe be later");
  if (MeshForm* form = find_mesh_form(body.form)) {
    if (reader.has("breakable") && form->is_breakable)
      reader.add_problem_at("breakable", "a scripted body does not break", "remove breakable");
    form->is_breakable = false;
  }
  read_path(reader, body);
}

// Ways and turns by name: "x", "rx".
void read_fixed(TableReader& reader, BodyEntry& body) {
  const TomlValue* value = reader.value("fixed");
  if (value == nullptr) return;
  const std::string example = "write fixed = [\"y\", \"rx\", \"rz\"]";
  if (!value->is_array()) {
    reader.add_problem(value->place, fmt::format("fixed must be a list, but is {}", kind_in_words(*value)),
                       example);
    return;
  }
  const std::vector<std::string> names{"x", "y", "z", "rx", "ry", "rz"};
  body::LockedAxes& locked = body.locked;
  for (const TomlValue& item : value->items) {
    if (!item.is_text()) {
      reader.add_problem(item.place, fmt::format("an axis is a word, but this is {}", kind_in_words(item)),
                         example);
      continue;
    }
    const auto found = std::find(names.begin(), names.end(), item.text);
    if (found == names.end()) {
      reader.add_problem(item.place, fmt::format("unknown axis \"{}\"", item.text),
                         hint_for_name(item.text, names, "available"));
      continue;
    }
    const auto axis = static_cast<std::size_t>(found - names.begin());
    (axis < 3 ? locked.moves[axis] : locked.turns[axis - 3]) = true;
  }
  if (locked.is_all())
    reader.add_problem_at("fixed", "a body of which all is fixed does not move", "write motion = \"static\"");
  const auto ask = [&](const char* key, const Vec3& wanted, const Vec3& left, const char* way) {
    if (wanted != left)
      reader.add_problem_at(key, fmt::format("{} goes {} an axis that is fixed", key, way),
                            "set it to 0 there, or take the axis out of fixed");
  };
  ask("velocity", body.velocity, locked.let_move(body.velocity), "along");
  ask("angular_velocity", body.angular_velocity, locked.let_turn(body.angular_velocity), "about");
}

}  // namespace

Quat turn_by(const Vec3& degrees) {
  return turn(degrees.z(), Vec3::UnitZ()) * turn(degrees.y(), Vec3::UnitY()) *
         turn(degrees.x(), Vec3::UnitX());
}

void read_motion(TableReader& reader, const std::string& kind, BodyEntry& body) {
  const bool is_plane = kind == "plane";
  const auto motion = reader.choice("motion", {"dynamic", "static", "scripted"});
  const bool is_held = !std::holds_alternative<std::monostate>(body.support);
  const std::string word = motion.value_or(is_plane || is_held ? "static" : "dynamic");
  body.motion = word == "static"     ? body::Motion::fixed
                : word == "scripted" ? body::Motion::scripted
                                     : body::Motion::dynamic;
  if (body.motion == body::Motion::scripted) {
    read_scripted(reader, is_held, body);
  } else {
    reader.foreign(kPathKeys, "it is for motion = \"scripted\"");
  }
  if (is_plane && body.motion == body::Motion::dynamic) {
    reader.add_problem_at("motion", "a plane cannot fall",
                          "write motion = \"static\" or \"scripted\", or take a box");
  }
  if (is_held && body.motion == body::Motion::dynamic) {
    reader.add_problem_at("motion", "a body with a support is held by the world and cannot move as a whole",
                          "remove motion or support; its pieces move once they break off");
  }
  if (body.motion == body::Motion::fixed) {
    reader.foreign({"velocity", "angular_velocity"}, "a static body does not move");
  } else if (body.motion == body::Motion::dynamic) {
    body.velocity = reader.vector("velocity", between(-1e4, 1e4, "m/s")).value_or(body.velocity);
    body.angular_velocity =
        reader.vector("angular_velocity", between(-1e5, 1e5, "rad/s")).value_or(body.angular_velocity);
    body.force = reader.vector("force", between(-1e9, 1e9, "N")).value_or(body.force);
    body.torque = reader.vector("torque", between(-1e9, 1e9, "N m")).value_or(body.torque);
    read_fixed(reader, body);
  }
  reader.foreign({"force", "torque"}, "they move what is motion = \"dynamic\"");
  reader.foreign({"path"}, "a camera has a path; a scripted body has keyframes");
  reader.foreign({"fixed"}, "it is for motion = \"dynamic\"");
}

}  // namespace shatterbox::sandbox::scene
