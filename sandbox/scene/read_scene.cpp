#include "sandbox/scene/read_scene.h"

#include <algorithm>
#include <filesystem>
#include <tuple>

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

struct Named {
  std::string name;
  Place place;
  bool is_given = false;  // otherwise it is called by its kind and number
};

/// All names, those given in the order of the text first.
std::vector<Named> names_in(const TomlValue& tree) {
  std::vector<Named> names;
  for (const char* kind : {"body", "material", "joint", "event"}) {
    const TomlValue* list = tree.find(kind);
    if (list == nullptr || !list->is_array()) continue;
    for (std::size_t i = 0; i < list->items.size(); ++i) {
      const TomlValue* name = list->items[i].find("name");
      if (name == nullptr)
        names.push_back({name_or_number(list->items[i], kind, i), list->items[i].place, false});
      else if (name->is_text())
        names.push_back({name->text, name->place, true});
    }
  }
  std::vector<std::string> files;
  for (const Named& n : names)
    if (std::find(files.begin(), files.end(), n.place.file) == files.end()) files.push_back(n.place.file);
  const auto order = [&](const Named& n) {
    return std::tuple(!n.is_given, std::find(files.begin(), files.end(), n.place.file), n.place.line);
  };
  std::stable_sort(names.begin(), names.end(),
                   [&](const Named& a, const Named& b) { return order(a) < order(b); });
  return names;
}

/// Names share one space: bodies, materials, joints, events and the words that --set knows.
void check_names(const TomlValue& tree, Problems& problems) {
  // In --set and for copies; of pieces, in groups of meshes and between columns of tables.
  constexpr const char* kTaken = ".[]=\"/#,";
  const std::vector<std::string> words{"scene", "camera", "light", "render", "pair"};
  std::vector<Named> seen;
  for (const Named& named : names_in(tree)) {
    const std::string& name = named.name;
    const auto bad = name.find_first_of(kTaken);
    if (name.empty() || bad != std::string::npos) {
      const std::string what = name.empty() ? "is empty" : fmt::format("contains '{}'", name[bad]);
      book(problems, named.place, fmt::format("the name \"{}\" {}", name, what),
           "names are used as in --set NAME.key=value, name[2] and name/0: use letters, digits, - and _");
      continue;
    }
    if (std::find(words.begin(), words.end(), name) != words.end()) {
      book(problems, named.place, fmt::format("nothing can be named \"{}\"", name),
           "it is the name of a part of the scene file");
      continue;
    }
    const auto twin =
        std::find_if(seen.begin(), seen.end(), [&](const Named& other) { return other.name == name; });
    if (twin == seen.end())
      seen.push_back(named);
    else if (named.is_given)
      book(problems, named.place, fmt::format("the name \"{}\" is taken", name),
           fmt::format("the first is at {}; bodies, materials, joints and events share their names",
                       describe(twin->place)));
    else
      book(problems, twin->place, fmt::format("the name \"{}\" is taken", name),
           fmt::format("what is at {} has no name and is called so; give it one", describe(named.place)));
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

/// Events and nothing else: what --script takes.
bool is_script(const TomlValue& tree) {
  return !tree.entries.empty() &&
         std::all_of(tree.entries.begin(), tree.entries.end(),
                     [](const auto& entry) { return entry.key == "event" && entry.value.is_array(); });
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
  if (is_script(tree) && (scene.bodies.empty() || !problems.empty()))
    book(problems, tree.entries.front().value.key_place,
         "events alone are a script, which is played on a scene",
         fmt::format("shatterbox run SCENE --script {}, or add a [[body]]", file));
  else if (scene.bodies.empty() && problems.empty())
    book(problems, Place{file, 0, 0}, "the scene has no body", "add a [[body]] with kind = \"shell\"");
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
