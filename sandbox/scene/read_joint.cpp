#include "sandbox/scene/read_joint.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "sandbox/scene/overrides.h"
#include "sandbox/scene/read_body.h"
#include "sandbox/scene/table_reader.h"

namespace shatterbox::sandbox::scene {

namespace {

/// Whom one item of `between` names. None, with a problem, if there is no such.
std::optional<BodyRef> read_partner(TableReader& reader, const TomlValue& item,
                                    const SceneDescription& scene) {
  if (!item.is_text()) {
    reader.add_problem(item.place,
                       fmt::format("between is a list of names, but has {}", kind_in_words(item)));
    return std::nullopt;
  }
  const std::optional<BodyRef> partner = read_body_ref(reader, item, scene);
  if (!partner) return std::nullopt;
  const BodyEntry& body = scene.bodies[static_cast<std::size_t>(partner->body)];
  if (body.is_held_back || body.repeat.every > 0.0) {
    reader.add_problem(
        item.place, fmt::format("body \"{}\" is not there from the start, and cannot be joined", body.name),
        "join bodies that no event and no \"every\" brings in");
    return std::nullopt;
  }
  return partner;
}

void read_partners(TableReader& reader, JointEntry& joint, const SceneDescription& scene) {
  const TomlValue* list = reader.value("between");
  if (list == nullptr || !list->is_array() || list->items.empty()) {
    reader.add_problem_at("between", fmt::format("{} does not say between whom it is", reader.what()),
                          "add between = [\"one\", \"other\"]; of copies, one name joins them to each other");
    return;
  }
  for (const TomlValue& item : list->items) {
    const auto partner = read_partner(reader, item, scene);
    if (partner && std::find(joint.partners.begin(), joint.partners.end(), *partner) == joint.partners.end())
      joint.partners.push_back(*partner);
  }
}

/// A point joins two bodies, each of which is one, or a row of copies.
void check_point(TableReader& reader, JointEntry& joint, const SceneDescription& scene) {
  const auto is_one = [&](const BodyRef& partner) {
    return partner.copy >= 0 || scene.bodies[static_cast<std::size_t>(partner.body)].repeat.total() == 1;
  };
  joint.is_chain = joint.partners.size() == 1 && !is_one(joint.partners[0]);
  if (joint.is_chain) {
    reader.foreign({"at"}, "each copy holds the next half way between them");
    return;
  }
  const TomlValue* at = reader.value("at");
  if (at == nullptr)
    reader.add_problem(reader.table().place, fmt::format("{} has no \"at\"", reader.what()),
                       "add at = [0, 1, 0]: the point that both bodies share, where they stand at the start");
  auto& pivot = std::get<world::PivotDescription>(joint.form);
  pivot.point = reader.vector("at", coordinate()).value_or(pivot.point);
  const TomlValue* between = reader.value("between");
  if (between == nullptr || between->items.size() > joint.partners.size()) return;  // told already
  if (joint.partners.size() == 2 && is_one(joint.partners[0]) && is_one(joint.partners[1])) return;
  reader.add_problem_at("between", fmt::format("{} holds a point of two bodies", reader.what()),
                        "name two, a copy as in \"bead[2]\"; or one that has copies: each holds the next");
}

/// Pa: the yield strength of structural steel, S355 of EN 10025-2.
constexpr double kPinStrength = 355e6;

}  // namespace

void read_joint(const TomlValue& table, std::size_t index, SceneDescription& scene, Problems& problems) {
  JointEntry joint;
  joint.place = table.place;
  joint.name = name_or_number(table, "joint", index);
  TableReader reader(table, fmt::format("joint \"{}\"", joint.name), problems);
  reader.text("name");
  const bool is_point = reader.choice("kind", {"mortar", "point"}).value_or("mortar") == "point";
  read_partners(reader, joint, scene);
  joint.strength =
      reader.number("strength", positive("Pa")).value_or(is_point ? kPinStrength : joint.strength);
  if (is_point) {
    world::PivotDescription pivot;
    pivot.area = reader.number("area", positive("m2")).value_or(pivot.area);
    joint.form = pivot;
    check_point(reader, joint, scene);
    reader.foreign({"gap", "shear_strength"}, "belongs to kind = \"mortar\"");
  } else {
    world::MortarDescription mortar;
    mortar.gap = reader.number("gap", extent()).value_or(mortar.gap);
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
