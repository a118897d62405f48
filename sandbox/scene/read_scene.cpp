#include "sandbox/scene/read_scene.h"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "sandbox/scene/find_scene.h"
#include "sandbox/scene/nearest_name.h"
#include "sandbox/scene/overrides.h"
#include "sandbox/scene/read_body.h"
#include "sandbox/scene/read_joint.h"
#include "sandbox/scene/read_picture.h"
#include "sandbox/scene/table_reader.h"

namespace shatterbox::sandbox::scene {

namespace {

const TomlValue kNothing;

/// The tables of [[key]], or none; a fault if it is written otherwise.
const std::vector<TomlValue>& tables_of(TableReader& root, const std::string& key) {
  const TomlValue* list = root.value(key);
  if (list == nullptr) return kNothing.items;
  const bool is_list = list->is_array() && std::all_of(list->items.begin(), list->items.end(),
                                                       [](const TomlValue& item) { return item.is_table(); });
  if (!is_list) {
    root.add_problem(list->place,
                     fmt::format("{} must be a list of tables, but is {}", key, kind_in_words(*list)),
                     fmt::format("write [[{}]] with double brackets", key));
    return kNothing.items;
  }
  return list->items;
}

/// The table [key], or an empty one.
const TomlValue& table_of(TableReader& root, const std::string& key) {
  const TomlValue* table = root.value(key);
  if (table == nullptr) return kNothing;
  if (!table->is_table()) {
    root.add_problem(table->place, fmt::format("{} must be a table, but is {}", key, kind_in_words(*table)),
                     fmt::format("write [{}] with single brackets, once", key));
    return kNothing;
  }
  return *table;
}

void read_settings(const TomlValue& table, SceneDescription& scene, Problems& problems) {
  TableReader reader(table, "[scene]", problems);
  scene.name = reader.text("name").value_or(std::filesystem::path(scene.file).stem().string());
  scene.takes = reader.text("takes").value_or("");
  scene.seconds = reader.number("seconds", between(1e-3, 86400.0, "s")).value_or(scene.seconds);
  world::WorldSettings& world = scene.world;
  world.steps_per_second =
      static_cast<int>(reader.whole_number("steps_per_second", 10, 100000).value_or(world.steps_per_second));
  world.gravity = reader.vector("gravity", between(-1e4, 1e4, "m/s2")).value_or(world.gravity);
  world.seed = static_cast<std::uint64_t>(
      reader.whole_number("seed", 0, std::int64_t{1} << 62).value_or(static_cast<std::int64_t>(world.seed)));
  const std::string criterion = reader.choice("criterion", {"event", "paper", "penalty"}).value_or("event");
  if (criterion == "paper") world.criterion = world::Criterion::paper;
  if (criterion == "penalty") world.criterion = world::Criterion::penalty;
  world.paper_duration = reader.number("paper_duration", positive("s")).value_or(world.paper_duration);
  const auto after = reader.choice("after_break", {"go_back", "inherit"});
  world.after_break =
      after.value_or("go_back") == "inherit" ? world::AfterBreak::inherit : world::AfterBreak::go_back;
  world.most_generations =
      static_cast<int>(reader.whole_number("most_generations", 1, 100).value_or(world.most_generations));
  world.has_energy_guard = reader.truth("energy_guard").value_or(world.has_energy_guard);
  world.has_sleep = reader.truth("sleep").value_or(world.has_sleep);
  const auto contact = reader.choice("contact", {"default", "paper"});
  world.contact =
      contact.value_or("default") == "paper" ? world::ContactScheme::paper : world::ContactScheme::standard;
  const TomlValue* window = reader.value("stress_window");
  if (window != nullptr && !(window->is_text() && window->text == "auto")) {
    if (window->is_text()) {
      reader.add_problem(window->place, fmt::format("stress_window cannot be \"{}\"", window->text),
                         "write \"auto\" or a time in seconds");
    } else {
      world.stress_window = reader.as_number(*window, "stress_window", positive("s"));
    }
  }
  reader.finish();
}

/// All names given, in the order of the text.
std::vector<const TomlValue*> names_in(const TomlValue& tree) {
  std::vector<const TomlValue*> names;
  for (const char* list_name : {"body", "material", "joint", "event"}) {
    const TomlValue* list = tree.find(list_name);
    if (list == nullptr || !list->is_array()) continue;
    for (const TomlValue& item : list->items) {
      const TomlValue* name = item.find("name");
      if (name != nullptr && name->is_text()) names.push_back(name);
    }
  }
  std::stable_sort(names.begin(), names.end(), [](const TomlValue* a, const TomlValue* b) {
    return a->place.file == b->place.file && a->place.line < b->place.line;
  });
  return names;
}

/// Names share one space: bodies, materials, joints, events and the words that --set knows.
void check_names(const TomlValue& tree, Problems& problems) {
  const std::vector<std::string> words{"scene", "camera", "light", "render", "pair"};
  std::vector<const TomlValue*> seen;
  for (const TomlValue* name : names_in(tree)) {
    const auto bad = name->text.find_first_of(".[]=\"");
    if (name->text.empty() || bad != std::string::npos) {
      const std::string what =
          name->text.empty() ? "is empty" : fmt::format("contains '{}'", name->text[bad]);
      book(problems, name->place, fmt::format("the name \"{}\" {}", name->text, what),
           "names are used as in --set NAME.key=value and name[2]: use letters, digits, - and _");
      continue;
    }
    if (std::find(words.begin(), words.end(), name->text) != words.end()) {
      book(problems, name->place, fmt::format("nothing can be named \"{}\"", name->text),
           "it is the name of a part of the scene file");
      continue;
    }
    const auto twin = std::find_if(seen.begin(), seen.end(),
                                   [name](const TomlValue* other) { return other->text == name->text; });
    if (twin == seen.end()) {
      seen.push_back(name);
    } else {
      book(problems, name->place, fmt::format("the name \"{}\" is taken", name->text),
           fmt::format("the first is at {}; bodies, materials, joints and events share their names",
                       describe((*twin)->place)));
    }
  }
}

/// Puts the events of a script behind those of the scene.
void append_script(TomlValue& tree, const std::string& script_file, Problems& problems) {
  const auto text = read_text_file(script_file, problems);
  if (!text) return;
  TomlValue script = parse_toml(*text, script_file, problems);
  for (auto& [key, value] : script.entries) {
    if (key != "event" || !value.is_array()) {
      problems.push_back(
          {value.key_place, fmt::format("a script holds [[event]] only, not \"{}\"", key),
           "bodies that an event throws can be given in it: body = {kind = \"sphere\", radius = 0.05}"});
      continue;
    }
    if (TomlValue* events = tree.find("event"); events == nullptr) {
      tree.entries.push_back({key, std::move(value)});
    } else if (events->is_array()) {
      std::move(value.items.begin(), value.items.end(), std::back_inserter(events->items));
    }
  }
}

SceneDescription read_tree(const TomlValue& tree, const std::string& file, Problems& problems) {
  SceneDescription scene;
  scene.file = file;
  TableReader root(tree, "the scene", problems);
  read_settings(table_of(root, "scene"), scene, problems);
  check_names(tree, problems);
  const auto& materials = tables_of(root, "material");
  for (std::size_t i = 0; i < materials.size(); ++i) read_material(materials[i], i, scene, problems);
  const auto& bodies = tables_of(root, "body");
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    read_body(bodies[i], name_or_number(bodies[i], "body", i), false, scene, problems);
  }
  for (const TomlValue& pair : tables_of(root, "pair")) read_pair(pair, scene, problems);
  for (const BodyEntry& body : scene.bodies) {
    if (body.path && scene.world.contact == world::ContactScheme::paper)
      book(problems, body.place,
           fmt::format("body \"{}\" is scripted, which the paper's contact does not know", body.name),
           "remove contact = \"paper\"");
  }
  const auto& events = tables_of(root, "event");
  for (std::size_t i = 0; i < events.size(); ++i) read_event(events[i], i, scene, problems);
  const auto& joints = tables_of(root, "joint");
  for (std::size_t i = 0; i < joints.size(); ++i) read_joint(joints[i], i, scene, problems);
  read_camera(table_of(root, "camera"), scene, problems);
  read_light(table_of(root, "light"), scene.light, problems);
  read_render(table_of(root, "render"), scene.render, problems);
  root.finish();
  if (scene.bodies.empty() && problems.empty()) {
    book(problems, Place{file, 0, 0}, "the scene has no body", "add a [[body]] with kind = \"shell\"");
  }
  std::stable_sort(scene.events.begin(), scene.events.end(), [](const EventEntry& a, const EventEntry& b) {
    return a.when == When::time && (b.when != When::time || a.at < b.at);
  });
  for (const EventEntry& event : scene.events) {
    if (event.when != When::time || event.at < scene.seconds) continue;
    scene.warnings.push_back(
        fmt::format("{}: event \"{}\" at {:g} s comes after the end of the scene at {:g} s",
                    describe(event.place), event.name, event.at, scene.seconds));
  }
  return scene;
}

}  // namespace

std::optional<SceneDescription> read_scene(std::string_view text, const std::string& file,
                                           const SceneChanges& changes, Problems& problems) {
  const std::size_t before = problems.size();
  TomlValue tree = parse_toml(text, file, problems);
  if (problems.size() > before) return std::nullopt;
  if (!changes.script_file.empty()) append_script(tree, changes.script_file, problems);
  for (const std::string& change : changes.overrides) apply_override(tree, change, problems);
  SceneDescription scene = read_tree(tree, file, problems);
  if (problems.size() > before) return std::nullopt;
  scene.goal = first_comment(text);
  return scene;
}

std::optional<SceneDescription> read_scene_file(const std::string& file, const SceneChanges& changes,
                                                Problems& problems) {
  const auto text = read_text_file(file, problems);
  if (!text) return std::nullopt;
  return read_scene(*text, file, changes, problems);
}

}  // namespace shatterbox::sandbox::scene
