#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "sandbox/scene/nearest_name.h"
#include "sandbox/scene/overrides.h"
#include "sandbox/scene/read_body.h"

namespace shatterbox::sandbox::scene {

namespace {

std::vector<std::string> material_names(const SceneDescription& scene) {
  std::vector<std::string> names;
  for (const MaterialEntry& entry : scene.materials) names.push_back(entry.material.name);
  for (const material::Preset& preset : material::presets()) {
    if (std::find(names.begin(), names.end(), preset.material.name) == names.end()) {
      names.push_back(preset.material.name);
    }
  }
  return names;
}

const MaterialEntry* find_entry(const SceneDescription& scene, const std::string& name) {
  for (const MaterialEntry& entry : scene.materials) {
    if (entry.material.name == name) return &entry;
  }
  return nullptr;
}

/// What the new material starts from.
MaterialEntry starting_point(TableReader& reader, const std::string& name, const SceneDescription& scene) {
  MaterialEntry entry;
  if (const auto like = reader.text("like")) {
    if (const MaterialEntry* known = find_entry(scene, *like)) return *known;
    if (const auto preset = material::find_preset(*like)) {
      entry.preset = *like;
      entry.material = *preset;
    } else {
      reader.add_problem_at("like", fmt::format("there is no material \"{}\" above to be like", *like),
                            hint_for_name(*like, material_names(scene), "materials"));
    }
    return entry;
  }
  if (const auto preset = material::find_preset(name)) {
    entry.preset = name;
    entry.material = *preset;
    return entry;
  }
  for (const char* key : {"density", "young", "poisson", "strength", "fracture_energy"}) {
    if (reader.has(key)) continue;
    reader.add_problem(reader.table().place,
                       fmt::format("{} has neither \"like\" nor \"{}\"", reader.what(), key),
                       "start from a preset, for example like = \"glass\", or give density, young, poisson, "
                       "strength and fracture_energy");
    break;
  }
  return entry;
}

/// The numbers of a [[material]].
struct MaterialNumber {
  const char* key;
  double material::Material::*member;
  Range range;
};

const std::vector<MaterialNumber>& material_numbers() {
  using material::Material;
  static const std::vector<MaterialNumber> numbers{
      {"density", &Material::density, positive("kg/m3")},
      {"young", &Material::young, positive("Pa")},
      {"poisson", &Material::poisson, between(0.0, 0.4999)},
      {"strength", &Material::strength, positive("Pa")},
      {"fracture_energy", &Material::fracture_energy, not_negative("J/m2")},
      {"yield", &Material::yield, not_negative("Pa")},
      {"elongation", &Material::elongation, positive()},
      {"plasticity", &Material::plasticity, not_negative()},
      {"surface_compression", &Material::surface_compression, not_negative("Pa")},
      {"weibull_modulus", &Material::weibull_modulus, positive()},
      {"flaw_area", &Material::flaw_area, positive("m2")},
      {"crack_spacing", &Material::crack_spacing, positive()},
      {"friction", &Material::friction, not_negative()},
      {"rolling_friction", &Material::rolling_friction, not_negative("m")},
      {"restitution", &Material::restitution, between(0.0, 1.0)},
      {"thickness", &Material::thickness, extent()},
      {"grain_size", &Material::grain_size, not_negative("m")},
      {"grain_strength", &Material::grain_strength, between(0.0, 1.0)},
  };
  return numbers;
}

}  // namespace

std::vector<std::string> material_keys() {
  std::vector<std::string> keys{"grain_direction"};
  for (const MaterialNumber& number : material_numbers()) keys.emplace_back(number.key);
  return keys;
}

int find_material(const std::string& name, const Place& place, SceneDescription& scene, Problems& problems) {
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    if (scene.materials[i].material.name == name) return static_cast<int>(i);
  }
  if (const auto preset = material::find_preset(name)) {
    scene.materials.push_back({place, name, *preset});
    return static_cast<int>(scene.materials.size()) - 1;
  }
  if (name == "wood") {
    book(problems, place,
         "wood is stiff and strong along its grain and weak across it; every material here is alike in all "
         "directions",
         "write look = \"wood\" and density = 700 on the body instead: it looks and weighs like wood, and "
         "does not break as wood would");
    return -1;
  }
  book(problems, place, fmt::format("there is no material \"{}\"", name),
       hint_for_name(name, material_names(scene), "materials"));
  return -1;
}

void read_material(const TomlValue& table, std::size_t index, SceneDescription& scene, Problems& problems) {
  const std::string name = name_or_number(table, "material", index);
  TableReader reader(table, fmt::format("material \"{}\"", name), problems);
  if (!reader.text("name") && !reader.has("name")) {
    reader.add_problem(table.place, "a [[material]] needs a name", "add name = \"...\"");
  }
  MaterialEntry entry = starting_point(reader, name, scene);
  entry.place = table.place;
  material::Material& m = entry.material;
  m.name = name;
  for (const auto& [key, member, range] : material_numbers())
    m.*member = reader.number(key, range).value_or(m.*member);
  m.grain_direction = reader.vector("grain_direction", any_number()).value_or(m.grain_direction);
  reader.finish();
  if (const auto fault = material::find_fault(m)) reader.add_problem(table.place, *fault);
  if (find_entry(scene, name) == nullptr) scene.materials.push_back(entry);
}

void read_pair(const TomlValue& table, SceneDescription& scene, Problems& problems) {
  TableReader reader(table, "[[pair]]", problems);
  PairEntry entry;
  entry.place = table.place;
  const TomlValue* between_value = reader.value("between");
  const bool has_two = between_value != nullptr && between_value->is_array() &&
                       between_value->items.size() == 2 && between_value->items[0].is_text() &&
                       between_value->items[1].is_text();
  if (has_two) {
    for (std::size_t i = 0; i < 2; ++i) {
      const TomlValue& item = between_value->items[i];
      entry.materials[i] = find_material(item.text, item.place, scene, problems);
    }
  } else {
    reader.add_problem_at("between", "a [[pair]] needs the names of two materials",
                          "write between = [\"glass\", \"steel\"]");
  }
  entry.friction = reader.number("friction", not_negative());
  entry.restitution = reader.number("restitution", between(0.0, 1.0));
  reader.finish();
  if (!entry.friction && !entry.restitution && !reader.has("friction") && !reader.has("restitution")) {
    reader.add_problem(table.place, "this [[pair]] changes nothing", "give friction or restitution");
  }
  if (has_two && entry.materials[0] >= 0 && entry.materials[1] >= 0) scene.pairs.push_back(entry);
}

}  // namespace shatterbox::sandbox::scene
