#include "sandbox/scene/read_body.h"

#include <algorithm>

#include <fmt/format.h>

#include "engine/core/elementary.h"
#include "sandbox/scene/nearest_name.h"
#include "sandbox/scene/read_mesh_form.h"

namespace shatterbox::sandbox::scene {

namespace {

const std::vector<std::string> kKinds{"shell", "solid", "plane", "box", "sphere", "capsule"};
const std::vector<std::string> kMeshKeys{"mesh", "shape", "scale", "up", "origin", "breakable", "support"};

Support read_support(TableReader& reader) {
  const TomlValue* value = reader.value("support");
  if (value == nullptr) return {};
  const std::string hint =
      "write support = \"edge\" (the open border), \"foot\" (the lowest part) or {box = [[x, y, z], [x, y, "
      "z]]}";
  if (value->is_text()) {
    if (value->text == "edge") return EdgeSupport{};
    if (value->text == "foot") return FootSupport{};
    reader.add_problem(value->place, fmt::format("unknown support \"{}\"", value->text), hint);
    return {};
  }
  const TomlValue* box = value->is_table() ? value->find("box") : nullptr;
  if (box == nullptr || value->entries.size() != 1 || !box->is_array() || box->items.size() != 2) {
    reader.add_problem(value->place, fmt::format("support cannot be {}", kind_in_words(*value)), hint);
    return {};
  }
  const auto least = reader.as_vector(box->items[0], "the first corner of the box", any_number("m"));
  const auto most = reader.as_vector(box->items[1], "the second corner of the box", any_number("m"));
  if (!least || !most) return {};
  return BoxSupport{least->cwiseMin(*most), least->cwiseMax(*most)};
}

Quat read_rotation(TableReader& reader) {
  const auto angles = reader.vector("rotation", between(-360000.0, 360000.0, "degrees"));
  const TomlValue* orientation = reader.value("orientation");
  if (orientation == nullptr) {
    return angles ? turn_by(*angles) : Quat::Identity();
  }
  if (reader.has("rotation")) {
    reader.add_problem(orientation->place, "a body has either a rotation or an orientation, not both",
                       "remove one of them");
    return Quat::Identity();
  }
  if (!orientation->is_array() || orientation->items.size() != 4) {
    reader.add_problem(
        orientation->place,
        fmt::format("orientation must be four numbers, but is {}", kind_in_words(*orientation)),
        "write [w, x, y, z], or rotation = [x, y, z] in degrees");
    return Quat::Identity();
  }
  std::array<double, 4> q{};
  double squared = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto number = reader.as_number(orientation->items[i], "a part of orientation", between(-1e6, 1e6));
    if (!number) return Quat::Identity();
    q[i] = *number;
    squared += *number * *number;
  }
  if (squared < 1e-12) {
    reader.add_problem(orientation->place, "orientation is zero and points nowhere",
                       "no turn is [1, 0, 0, 0]");
    return Quat::Identity();
  }
  const double length = core::sqrt(squared);
  return {q[0] / length, q[1] / length, q[2] / length, q[3] / length};
}

CapsuleForm read_capsule(TableReader& reader) {
  CapsuleForm form;
  const auto radius = reader.number("radius", extent()), length = reader.number("length", extent());
  if (radius && !reader.has("length")) form.length = 4.0 * *radius;
  if (length && !reader.has("radius")) form.radius = 0.25 * *length;
  form.radius = radius.value_or(form.radius);
  form.length = length.value_or(form.length);
  if (radius && length && !(*length > 2.0 * *radius))
    reader.add_problem_at("length",
                          fmt::format("a capsule of radius {:g} m is {:g} m long with its round ends alone",
                                      *radius, 2.0 * *radius),
                          "length is from tip to tip; what is not longer is a sphere");
  reader.foreign(shape_keys(), "a capsule has a radius and a length only");
  reader.foreign({"size"}, "a capsule has a radius and a length only");
  return form;
}

/// Of what is no shell.
std::string where_thickness_belongs(const TableReader& reader, const std::string& kind) {
  const TomlValue* shape = reader.table().find("shape");
  const bool has_wall =
      shape != nullptr && shape->is_text() && (shape->text == "vase" || shape->text == "bottle");
  if (kind == "solid" && has_wall)
    return fmt::format("it is for kind = \"shell\"; how thick a solid {} is, is its wall", shape->text);
  return fmt::format("it is for kind = \"shell\"; this is a {}", kind);
}

decltype(BodyEntry::form) read_form(TableReader& reader, const std::string& kind,
                                    const SceneDescription& scene) {
  if (kind != "solid") reader.foreign({"element_size", "grading"}, "it is for kind = \"solid\"");
  if (kind == "shell") return read_shell(reader, scene);
  reader.foreign({"thickness"}, where_thickness_belongs(reader, kind));
  if (kind == "solid") return read_solid(reader, scene);
  reader.foreign(kMeshKeys, fmt::format("it is for kind = \"shell\" or \"solid\"; this is a {}", kind));
  if (kind == "sphere") {
    SphereForm form;
    form.radius = reader.number("radius", extent()).value_or(form.radius);
    reader.foreign(shape_keys(), "a sphere has a radius only");
    reader.foreign({"size"}, "a sphere has a radius only");
    return form;
  }
  if (kind == "capsule") return read_capsule(reader);
  if (kind == "box") {
    BoxForm form;
    form.size = reader.number_or_vector("size", extent()).value_or(form.size);
    if (!reader.has("size")) {
      reader.add_problem(reader.table().place, fmt::format("{} has no size", reader.what()),
                         "add size = [x, y, z] in metres");
    }
    reader.foreign(shape_keys(), "a box has size = [x, y, z] only");
    return form;
  }
  reader.foreign(shape_keys(), "a plane has no end and no sizes");
  reader.foreign({"size"}, "a plane has no end and no sizes");
  return PlaneForm{};
}

std::optional<Vec3> as_colour(TableReader& reader, const TomlValue& value, const std::string& key) {
  if (!value.is_text()) return reader.as_vector(value, key, between(0.0, 1.0));
  const std::string& text = value.text;
  const bool is_hex =
      text.size() == 7 && text[0] == '#' &&
      std::all_of(text.begin() + 1, text.end(), [](unsigned char c) { return std::isxdigit(c) != 0; });
  if (!is_hex) {
    reader.add_problem(value.place, fmt::format("\"{}\" is no colour", text),
                       "write \"#b3202c\" or [0.7, 0.13, 0.17]");
    return std::nullopt;
  }
  const auto channel = [&text](std::size_t i) { return std::stoi(text.substr(i, 2), nullptr, 16) / 255.0; };
  return Vec3(channel(1), channel(3), channel(5));
}

/// One colour, or a list of them for the copies of a body.
std::vector<Vec3> read_colours(TableReader& reader) {
  const TomlValue* value = reader.value("colour");
  if (value == nullptr) return {};
  const bool is_list = value->is_array() && !value->items.empty() &&
                       (value->items.front().is_text() || value->items.front().is_array());
  std::vector<Vec3> colours;
  const auto add = [&](const TomlValue& item) {
    if (const auto colour = as_colour(reader, item, "colour")) colours.push_back(*colour);
  };
  if (!is_list) add(*value);
  for (std::size_t i = 0; is_list && i < value->items.size(); ++i) add(value->items[i]);
  return colours;
}

/// A solid that stands still without being held is scenery: it breaks only if the scene says so.
void settle_breaking(TableReader& reader, const BodyEntry& body, SolidForm& solid) {
  const bool is_held = !std::holds_alternative<std::monostate>(body.support);
  if (body.motion == body::Motion::fixed && !is_held && !reader.has("breakable")) solid.is_breakable = false;
  for (const char* key : {"element_size", "grading"})
    if (reader.has(key) && !solid.is_breakable)
      reader.add_problem_at(key, "only a breakable solid is divided into elements",
                            "remove it, or write breakable = true");
}

/// A wall along x, about `position` in the middle of its foot. Courses are shifted by a third of a brick: one
/// that stood out by half of it would tip.
void lay_bricks(TableReader& reader, BodyEntry& body) {
  const MeshForm* const form = find_mesh_form(body.form);
  const auto* const brick = form != nullptr && form->wall ? std::get_if<SlabShape>(&form->shape) : nullptr;
  if (brick == nullptr) return;
  for (const char* key : {"repeat", "rotation"})
    if (reader.has(key))
      reader.add_problem_at(key, "a wall of bricks lies along x, each brick once",
                            "lay a slab with repeat and bond, as the scene brick_wall does");
  const Vec3 gap(0.001, 0.0001, 0.001);  // m: they touch from above and below
  const Vec3 pitch = brick->size + gap;
  const Eigen::Array3d fitting = ((*form->wall + gap).array() / pitch.array() + 1e-9).floor().max(1.0);
  if (fitting.prod() > kMostCopies) {
    reader.add_problem_at("size", fmt::format("more than {} bricks", kMostCopies));
    return;
  }
  Repeat& repeat = body.repeat;
  repeat.layout = Layout::grid;
  for (int k = 0; k < 3; ++k) repeat.count[static_cast<std::size_t>(k)] = static_cast<int>(fitting[k]);
  repeat.spacing = pitch;
  repeat.bond = repeat.count[1] > 1 ? 1.0 / 3.0 : 0.0;
  body.position += Vec3(-0.5 * (repeat.count[0] - 1 + repeat.bond) * pitch.x(),
                        0.5 * brick->size.y() + gap.y(), -0.5 * (repeat.count[2] - 1) * pitch.z());
}

}  // namespace

std::optional<Vec3> read_colour(TableReader& reader, const std::string& key) {
  const TomlValue* value = reader.value(key);
  return value == nullptr ? std::nullopt : as_colour(reader, *value, key);
}

int find_body(const SceneDescription& scene, const std::string& name) {
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    if (scene.bodies[i].name == name) return static_cast<int>(i);
  }
  return -1;
}

void read_body(const TomlValue& table, const std::string& name, bool is_held_back, SceneDescription& scene,
               Problems& problems) {
  TableReader reader(table, fmt::format("body \"{}\"", name), problems);
  BodyEntry body;
  body.place = table.place;
  body.name = reader.text("name").value_or(name);
  body.is_held_back = is_held_back;
  const bool looks_like_shell = !reader.has("kind") && (reader.has("mesh") || reader.has("shape"));
  const auto kind = reader.choice("kind", kKinds);
  if (!reader.has("kind") && !looks_like_shell) {
    reader.add_problem(table.place, fmt::format("{} has no kind", reader.what()),
                       fmt::format("add kind = one of {}", quoted_list(kKinds)));
  }
  if (!kind && !looks_like_shell) {  // what else belongs here depends on the kind
    scene.bodies.push_back(body);
    return;
  }
  const std::string form_kind = kind.value_or("shell");
  body.form = read_form(reader, form_kind, scene);
  if (find_mesh_form(body.form) != nullptr) {
    body.support = read_support(reader);
    if (form_kind == "solid" && std::holds_alternative<EdgeSupport>(body.support))
      reader.add_problem_at("support", "a solid has no open border to be held by",
                            "use \"foot\" or {box = [[x, y, z], [x, y, z]]}");
  }
  const bool is_ceramic = form_kind == "plane" || form_kind == "solid";
  const std::string fallback = form_kind == "shell" ? "glass" : is_ceramic ? "ceramic" : "steel";
  const std::string material = reader.text("material").value_or(fallback);
  const TomlValue* material_value = table.find("material");
  body.material = find_material(material, material_value != nullptr ? material_value->place : table.place,
                                scene, problems);
  body.density = reader.number("density", positive("kg/m3"));
  body.position = reader.vector("position", coordinate()).value_or(body.position);
  body.rotation = read_rotation(reader);
  read_motion(reader, form_kind, body);
  if (auto* solid = std::get_if<SolidForm>(&body.form)) settle_breaking(reader, body, *solid);
  body.group = reader.text("group").value_or("");
  body.contact_duration = reader.number("contact_duration", positive("s"));
  body.repeat = read_repeat(reader);
  lay_bricks(reader, body);
  if (body.motion == body::Motion::scripted && body.repeat.every > 0.0)
    reader.add_problem_at("repeat", "scripted bodies are all there from the start", "remove every");
  body.look.name = reader.choice("look", kLookNames).value_or("");
  body.look.colours = read_colours(reader);
  reader.foreign({"mass"}, "it follows from size and density: write density in kg/m3");
  reader.foreign({"static"}, "write motion = \"static\"");
  reader.foreign(
      material_keys(),
      fmt::format("it belongs to a material: [[material]] with name = \"mine\" and like = \"{}\", and "
                  "material = \"mine\" here",
                  material));
  reader.finish();
  scene.bodies.push_back(std::move(body));
}

}  // namespace shatterbox::sandbox::scene
