#include "sandbox/scene/read_joint.h"

#include <algorithm>

#include <fmt/format.h>

#include "sandbox/scene/nearest_name.h"
#include "sandbox/scene/overrides.h"
#include "sandbox/scene/read_body.h"
#include "sandbox/scene/table_reader.h"

namespace shatterbox::sandbox::scene {

namespace {

/// The number of the body that one item of `between` names; -1 with a problem.
int read_partner(TableReader& reader, const TomlValue& item, const SceneDescription& scene) {
  if (!item.is_text()) {
    reader.add_problem(item.place,
                       fmt::format("between is a list of names, but has {}", kind_in_words(item)));
    return -1;
  }
  const int found = find_body(scene, item.text);
  if (found < 0) {
    std::vector<std::string> names;
    for (const BodyEntry& body : scene.bodies) names.push_back(body.name);
    reader.add_problem(item.place, fmt::format("there is no body \"{}\"", item.text),
                       hint_for_name(item.text, names, "bodies"));
    return -1;
  }
  const BodyEntry& body = scene.bodies[static_cast<std::size_t>(found)];
  if (body.is_held_back || body.repeat.every > 0.0) {
    reader.add_problem(
        item.place, fmt::format("body \"{}\" is not there from the start, and cannot be joined", item.text),
        "join bodies that no event and no \"every\" brings in");
    return -1;
  }
  return found;
}

void read_partners(TableReader& reader, JointEntry& joint, const SceneDescription& scene) {
  const TomlValue* list = reader.value("between");
  if (list == nullptr || !list->is_array() || list->items.empty()) {
    reader.add_problem_at("between", fmt::format("{} does not say between whom it is", reader.what()),
                          "add between = [\"one\", \"other\"]; of copies, one name joins them to each other");
    return;
  }
  for (const TomlValue& item : list->items) {
    const int body = read_partner(reader, item, scene);
    if (body >= 0 && std::find(joint.bodies.begin(), joint.bodies.end(), body) == joint.bodies.end())
      joint.bodies.push_back(body);
  }
}

/// A point joins two bodies, each of which is one.
void check_point(TableReader& reader, const JointEntry& joint, const SceneDescription& scene) {
  if (!reader.has("at"))
    reader.add_problem(reader.table().place, fmt::format("{} has no \"at\"", reader.what()),
                       "add at = [0, 1, 0]: the point that both bodies share, where they stand at the start");
  if (!reader.value("between")) return;
  const bool has_copies = std::any_of(joint.bodies.begin(), joint.bodies.end(), [&](int body) {
    return scene.bodies[static_cast<std::size_t>(body)].repeat.total() > 1;
  });
  if (joint.bodies.size() == 2 && !has_copies) return;
  reader.add_problem_at("between", fmt::format("{} holds a point of two bodies", reader.what()),
                        "name two that have no copies");
}

}  // namespace

void read_joint(const TomlValue& table, std::size_t index, SceneDescription& scene, Problems& problems) {
  JointEntry joint;
  joint.place = table.place;
  joint.name = name_or_number(table, "joint", index);
  TableReader reader(table, fmt::format("joint \"{}\"", joint.name), problems);
  reader.text("name");
  const bool is_point = reader.choice("kind", {"mortar", "point"}).value_or("mortar") == "point";
  read_partners(reader, joint, scene);
  joint.strength = reader.number("strength", positive("Pa")).value_or(joint.strength);
  if (is_point) {
    world::PivotDescription pivot;
    pivot.point = reader.vector("at", coordinate()).value_or(pivot.point);
    pivot.area = reader.number("area", positive("m2")).value_or(pivot.area);
    joint.form = pivot;
    check_point(reader, joint, scene);
    reader.foreign({"gap", "shear_strength"}, "belongs to kind = \"mortar\"");
  } else {
    world::MortarDescription mortar;
    mortar.gap = reader.number("gap", positive("m")).value_or(mortar.gap);
    joint.form = mortar;
    joint.shear_strength = reader.number("shear_strength", positive("Pa")).value_or(joint.shear_strength);
    reader.foreign({"at", "area"}, "belongs to kind = \"point\"");
  }
  reader.finish();
  scene.joints.push_back(std::move(joint));
  if (scene.world.contact == world::ContactScheme::paper)
    book(problems, table.place,
         fmt::format("joint \"{}\": the paper's contact knows no joints", scene.joints.back().name),
         "remove contact = \"paper\"");
}

}  // namespace shatterbox::sandbox::scene
