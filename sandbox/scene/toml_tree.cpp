#include "sandbox/scene/toml_tree.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <utility>

#define TOML_ENABLE_FORMATTERS 0
#include <toml++/toml.h>

namespace shatterbox::sandbox::scene {

bool is_bare_point(std::string_view text, std::size_t place) {
  const bool begins =
      place == 0 || std::string_view("[,=+- \t").find(text[place - 1]) != std::string_view::npos;
  return begins && place + 1 < text.size() && text[place] == '.' &&
         std::isdigit(static_cast<unsigned char>(text[place + 1])) != 0;
}

namespace {

Place place_of(const toml::source_region& region, const std::string& file) {
  return {file, static_cast<int>(region.begin.line), static_cast<int>(region.begin.column)};
}

bool comes_before(const Place& a, const Place& b) {
  return a.line != b.line ? a.line < b.line : a.column < b.column;
}

TomlValue convert(const toml::node& node, const std::string& file) {
  TomlValue value;
  value.place = place_of(node.source(), file);
  value.key_place = value.place;
  switch (node.type()) {
    case toml::node_type::table:
      for (const auto& [key, entry] : *node.as_table()) {
        TomlValue child = convert(entry, file);
        child.key_place = place_of(key.source(), file);
        value.entries.push_back({std::string(key.str()), std::move(child)});
      }
      // toml++ sorts by key; people read in the order of the text.
      std::stable_sort(value.entries.begin(), value.entries.end(), [](const auto& a, const auto& b) {
        return comes_before(a.value.key_place, b.value.key_place);
      });
      break;
    case toml::node_type::array:
      value.kind = TomlKind::array;
      for (const toml::node& item : *node.as_array()) value.items.push_back(convert(item, file));
      break;
    case toml::node_type::string:
      value.kind = TomlKind::text;
      value.text = node.as_string()->get();
      break;
    case toml::node_type::integer:
      value.kind = TomlKind::whole;
      value.whole = node.as_integer()->get();
      value.real = static_cast<double>(value.whole);
      break;
    case toml::node_type::floating_point:
      value.kind = TomlKind::real;
      value.real = node.as_floating_point()->get();
      break;
    case toml::node_type::boolean:
      value.kind = TomlKind::truth;
      value.truth = node.as_boolean()->get();
      break;
    default:
      value.kind = TomlKind::date;
  }
  return value;
}

/// A line of a text.
std::string_view line_of(std::string_view text, int number) {
  for (int line = 1; line < number; ++line) text.remove_prefix(std::min(text.find('\n') + 1, text.size()));
  return text.substr(0, text.find('\n'));
}

/// Whether what could not be read is such a number.
bool lacks_digit(std::string_view text, const Place& place) {
  const auto column = static_cast<std::size_t>(std::max(place.column, 1));
  return is_bare_point(line_of(text, place.line), column - 1);
}

/// Whether what could not be read is a unit behind a number: "4mm", "0.5 cm".
bool is_unit(std::string_view text, const Place& place) {
  text = line_of(text, place.line);
  constexpr std::string_view kLetters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ ";
  // The place is that of the letter, or behind it.
  const std::string_view before = text.substr(0, static_cast<std::size_t>(std::max(place.column, 0)));
  const std::size_t last = before.find_last_not_of(kLetters);
  return last != std::string_view::npos && std::isdigit(static_cast<unsigned char>(before[last])) != 0 &&
         text.find_first_of(kLetters.substr(0, kLetters.size() - 1), last) != std::string_view::npos;
}

/// What was probably meant where the parser gives up with these words.
std::string hint_for_syntax(const std::string& what, std::string_view text, const Place& place) {
  const std::string is_none = "this is not TOML";
  if (lacks_digit(text, place)) return is_none + ": a digit stands before the point of a number, as in 0.5";
  if (is_unit(text, place))
    return is_none +
           ": numbers have no unit; lengths are metres (10 cm are 0.1), masses kg, times s, angles degrees";
  if (what.find("control characters") != std::string::npos)
    return is_none + ": a text ends with its second quote, on the same line: \"glass\"";
  if (what.find("redefine existing array") != std::string::npos)
    return is_none + ": what there are several of has double brackets, as [[body]]";
  return is_none + "; values look like 1.5, \"text\", true, [1, 2, 3] or {x = 1}";
}

}  // namespace

const TomlValue* TomlValue::find(std::string_view key) const {
  const auto found =
      std::find_if(entries.begin(), entries.end(), [key](const auto& entry) { return entry.key == key; });
  return found == entries.end() ? nullptr : &found->value;
}

TomlValue* TomlValue::find(std::string_view key) {
  return const_cast<TomlValue*>(std::as_const(*this).find(key));
}

std::string kind_in_words(const TomlValue& value) {
  switch (value.kind) {
    case TomlKind::table:
      return "a table";
    case TomlKind::array:
      return "a list of " + std::to_string(value.items.size());
    case TomlKind::text:
      return "the text \"" + value.text + "\"";
    case TomlKind::whole:
      return "the number " + std::to_string(value.whole);
    case TomlKind::real: {
      std::ostringstream text;
      text << "the number " << value.real;
      return text.str();
    }
    case TomlKind::truth:
      return value.truth ? "true" : "false";
    case TomlKind::date:
      break;
  }
  return "a date";
}

TomlValue parse_toml(std::string_view text, const std::string& file, Problems& problems) {
  try {
    const toml::table table = toml::parse(text, file);
    TomlValue value = convert(table, file);
    value.place = {file, 1, 1};
    return value;
  } catch (const toml::parse_error& error) {
    const Place place = place_of(error.source(), file);
    const std::string what(error.description());
    book(problems, place, what, hint_for_syntax(what, text, place));
    TomlValue empty;
    empty.place = {file, 0, 0};
    return empty;
  }
}

std::optional<std::string> read_text_file(const std::string& path, Problems& problems) {
  const Place place{path, 0, 0};
  std::error_code code;
  if (std::filesystem::is_directory(path, code)) {
    book(problems, place, "is a folder, not a file", "name a .toml file in it");
    return std::nullopt;
  }
  std::ifstream stream(path, std::ios::binary);
  if (!stream) {
    book(problems, place, std::string("cannot be read: ") + std::strerror(errno), "");
    return std::nullopt;
  }
  std::ostringstream content;
  content << stream.rdbuf();
  return content.str();
}

}  // namespace shatterbox::sandbox::scene
