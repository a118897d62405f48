#include "sandbox/scene/overrides.h"

#include <algorithm>

#include "sandbox/scene/nearest_name.h"

namespace shatterbox::sandbox::scene {

namespace {

constexpr const char* kForm = "write --set NAME.key=value, for example --set ball.speed=12";

std::string without_outer_blanks(const std::string& text) {
  const std::size_t first = text.find_first_not_of(' ');
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(' ') - first + 1);
}

std::vector<std::string> split_at_dots(const std::string& text) {
  std::vector<std::string> parts;
  std::size_t first = 0;
  for (std::size_t dot = 0; dot != std::string::npos; first = dot + 1) {
    dot = text.find('.', first);
    parts.push_back(without_outer_blanks(text.substr(first, dot == std::string::npos ? dot : dot - first)));
  }
  return parts;
}

void move_to(TomlValue& value, const Place& place) {
  value.place = value.key_place = place;
  for (TomlValue& item : value.items) move_to(item, place);
  for (auto& [key, entry] : value.entries) move_to(entry, place);
}

/// What is typed in a hurry: numbers that begin with their point get the digit that TOML asks for.
std::string with_leading_digits(const std::string& text) {
  std::string full;
  char quote = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quote == 0 && (c == '"' || c == '\''))
      quote = c;
    else if (c == quote)
      quote = 0;
    if (quote == 0 && is_bare_point(text, i)) full += '0';
    full += c;
  }
  return full;
}

/// The value behind the equals sign, or nothing after adding a problem.
const TomlValue* parse_value(const std::string& text, const Place& place, TomlValue& storage,
                             Problems& problems) {
  Problems faults;
  storage = parse_toml("value = " + with_leading_digits(text), place.file, faults);
  // The shell takes quotes for its own: a word that is no other value is a text.
  const std::string word = without_outer_blanks(text);
  const bool is_word = !word.empty() && std::all_of(word.begin(), word.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-' || c == '/' || c == '.' || c == '#';
  });
  if (is_word && !faults.empty()) {
    faults.clear();
    storage = parse_toml("value = \"" + word + "\"", place.file, faults);
  }
  if (!faults.empty() || storage.entries.size() != 1) {
    book(problems, place, "\"" + text + "\" is not a value",
         "values are TOML: 1.5, true, [0, 1, 0], and texts, which need quotes where they are more than a "
         "word");
    return nullptr;
  }
  move_to(storage, place);
  return &storage.entries.front().value;
}

TomlValue* find_named(TomlValue& scene, const std::string& name, std::vector<std::string>& known) {
  for (const char* table : {"scene", "camera", "light", "render"}) {
    known.emplace_back(table);
    if (name != table) continue;
    if (scene.find(table) == nullptr) {
      TomlValue empty;
      empty.place = empty.key_place = scene.place;
      scene.entries.push_back({table, empty});
    }
    return scene.find(table);
  }
  for (const char* list_name : {"body", "material", "joint", "event"}) {
    TomlValue* list = scene.find(list_name);
    if (list == nullptr || !list->is_array()) continue;
    for (std::size_t i = 0; i < list->items.size(); ++i) {
      known.push_back(name_or_number(list->items[i], list_name, i));
      if (known.back() == name) return &list->items[i];
    }
  }
  return nullptr;
}

}  // namespace

std::string name_or_number(const TomlValue& table, const std::string& kind, std::size_t index) {
  const TomlValue* name = table.find("name");
  if (name != nullptr && name->is_text() && !name->text.empty()) return name->text;
  return kind + std::to_string(index + 1);
}

void apply_override(TomlValue& scene, const std::string& change, Problems& problems) {
  const Place place{"--set " + change, 0, 0};
  const std::size_t equals = change.find('=');
  const std::vector<std::string> path = split_at_dots(change.substr(0, equals));
  const bool has_hole =
      std::any_of(path.begin(), path.end(), [](const std::string& part) { return part.empty(); });
  if (equals == std::string::npos || path.size() < 2 || has_hole) {
    book(problems, place, "is not NAME.key=value", kForm);
    return;
  }
  TomlValue storage;
  const TomlValue* value = parse_value(change.substr(equals + 1), place, storage, problems);
  if (value == nullptr) return;

  std::vector<std::string> known;
  TomlValue* table = find_named(scene, path.front(), known);
  if (table == nullptr) {
    book(problems, place, "nothing is named \"" + path.front() + "\"",
         hint_for_name(path.front(), known, "names in this scene"));
    return;
  }
  for (std::size_t i = 1; i + 1 < path.size(); ++i) {
    if (!table->is_table()) break;
    if (table->find(path[i]) == nullptr) {
      TomlValue empty;
      empty.place = empty.key_place = place;
      table->entries.push_back({path[i], empty});
    }
    table = table->find(path[i]);
  }
  if (!table->is_table()) {
    book(problems, place, "\"" + path[path.size() - 2] + "\" is " + kind_in_words(*table) + ", not a table",
         "set it as a whole");
    return;
  }
  // A body has a mesh or a shape: who is given the one drops the other.
  const std::string rival = path.back() == "mesh" ? "shape" : path.back() == "shape" ? "mesh" : "";
  if (path.size() == 2)
    std::erase_if(table->entries, [&](const TomlEntry& entry) { return entry.key == rival; });
  if (TomlValue* old = table->find(path.back())) {
    *old = *value;
  } else {
    table->entries.push_back({path.back(), *value});
  }
}

}  // namespace shatterbox::sandbox::scene
