// A TOML text as a tree of values that know their place, so that every later complaint can name it; and the
// changes that --set makes to such a tree. The only door to toml++.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sandbox/scene/problem.h"

namespace shatterbox::sandbox::scene {

enum class TomlKind : std::uint8_t { table, array, text, whole, real, truth, date };

struct TomlEntry;

struct TomlValue {
  TomlKind kind = TomlKind::table;
  Place place;      // of the value
  Place key_place;  // of its key, for values in tables
  std::string text;
  std::int64_t whole = 0;
  double real = 0.0;
  bool truth = false;
  std::vector<TomlValue> items;    // of an array
  std::vector<TomlEntry> entries;  // of a table, in the order of the text

  bool is_table() const { return kind == TomlKind::table; }
  bool is_array() const { return kind == TomlKind::array; }
  bool is_text() const { return kind == TomlKind::text; }
  /// The entry of that key, or null.
  const TomlValue* find(std::string_view key) const;
  TomlValue* find(std::string_view key);
};

struct TomlEntry {
  std::string key;
  TomlValue value;
};

/// "a table", "a number", ...: for sentences.
std::string kind_in_words(const TomlValue& value);

/// Whether a number begins with its point at this place, as ".5" and "-.5" do: TOML asks for a digit there.
bool is_bare_point(std::string_view text, std::size_t place);

/// Reads a TOML text. A text that is no TOML adds one problem (with line and column) and gives an empty
/// table.
TomlValue parse_toml(std::string_view text, const std::string& file, Problems& problems);

/// The content of a file; nothing, with a problem, if it cannot be read.
std::optional<std::string> read_text_file(const std::string& path, Problems& problems);

}  // namespace shatterbox::sandbox::scene
