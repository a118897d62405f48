// Reads one TOML table key by key: types, ranges and units are checked, each fault is booked with its place,
// and keys that nobody asked for are faults too.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/vec.h"
#include "sandbox/scene/toml_tree.h"

namespace shatterbox::sandbox::scene {

/// The numbers that a key accepts, and how to say so.
struct Range {
  double least, most;
  bool least_is_open = false;  // `least` itself is not accepted
  std::string_view unit = "";  // "m", "Pa", ...
};

constexpr double kHuge = 1e30;  // no number in a scene is larger; keeps squares finite

inline Range any_number(std::string_view unit = "") {
  return {-kHuge, kHuge, false, unit};
}
inline Range positive(std::string_view unit = "") {
  return {0.0, kHuge, true, unit};
}
inline Range not_negative(std::string_view unit = "") {
  return {0.0, kHuge, false, unit};
}
inline Range between(double least, double most, std::string_view unit = "") {
  return {least, most, false, unit};
}
/// Of a thing: far above rounding at places of some metres, and within them.
inline Range extent() {
  return between(1e-9, 1e6, "m");
}
/// Of a place.
inline Range coordinate() {
  return between(-1e6, 1e6, "m");
}

class TableReader {
 public:
  /// `what` names the table in sentences: "[scene]", "body \"ball\"".
  TableReader(const TomlValue& table, std::string what, Problems& problems);

  const TomlValue& table() const { return table_; }
  const std::string& what() const { return what_; }
  Problems& problems() { return problems_; }
  bool has(std::string_view key) const { return table_.find(key) != nullptr; }

  // Each of these declares `key` as known and gives its value, or nothing when it is absent or wrong (then a
  // problem is booked).
  std::optional<double> number(const std::string& key, const Range& range);
  std::optional<std::int64_t> whole_number(const std::string& key, std::int64_t least, std::int64_t most);
  std::optional<bool> truth(const std::string& key);
  std::optional<std::string> text(const std::string& key);
  std::optional<Vec3> vector(const std::string& key, const Range& range);
  /// A vector, or one number for all three axes.
  std::optional<Vec3> number_or_vector(const std::string& key, const Range& range);
  std::optional<std::string> choice(const std::string& key, const std::vector<std::string>& choices);
  /// The raw value, or null.
  const TomlValue* value(const std::string& key);

  /// Keys that exist but do not belong here; `reason` says where they do.
  void foreign(const std::vector<std::string>& keys, const std::string& reason);

  /// Books every key that was never asked for, with the nearest one that was.
  void finish();

  void add_problem(const Place& place, std::string message, std::string hint = "");
  /// A fault of the value of `key`, or of the whole table if there is none.
  void add_problem_at(std::string_view key, std::string message, std::string hint = "");

  // The same checks on a value that is not in a table.
  std::optional<double> as_number(const TomlValue& value, const std::string& name, const Range& range);
  std::optional<Vec3> as_vector(const TomlValue& value, const std::string& name, const Range& range);

 private:
  const TomlValue* find_known(const std::string& key);

  const TomlValue& table_;
  std::string what_;
  Problems& problems_;
  std::vector<std::string> known_;
  std::vector<std::string> told_;  // keys with a fault of their own already
};

/// "more than 0 m", "0 to 1", ...
std::string describe(const Range& range);

}  // namespace shatterbox::sandbox::scene
