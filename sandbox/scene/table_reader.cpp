#include "sandbox/scene/table_reader.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "sandbox/scene/nearest_name.h"

namespace shatterbox::sandbox::scene {

namespace {

bool contains(const std::vector<std::string>& list, std::string_view name) {
  return std::find(list.begin(), list.end(), name) != list.end();
}

}  // namespace

std::string describe(const Range& range) {
  const std::string unit = range.unit.empty() ? "" : fmt::format(" {}", range.unit);
  const bool has_least = range.least > -kHuge, has_most = range.most < kHuge;
  if (has_least && has_most) return fmt::format("from {:g} to {:g}{}", range.least, range.most, unit);
  if (has_least && range.least_is_open) return fmt::format("greater than {:g}{}", range.least, unit);
  if (has_least) return fmt::format("at least {:g}{}", range.least, unit);
  if (has_most) return fmt::format("at most {:g}{}", range.most, unit);
  return range.unit.empty() ? "finite" : fmt::format("finite, in {}", range.unit);
}

TableReader::TableReader(const TomlValue& table, std::string what, Problems& problems)
    : table_(table), what_(std::move(what)), problems_(problems) {}

const TomlValue* TableReader::find_known(const std::string& key) {
  if (!contains(known_, key)) known_.push_back(key);
  return table_.find(key);
}

const TomlValue* TableReader::value(const std::string& key) {
  return find_known(key);
}

void TableReader::add_problem(const Place& place, std::string message, std::string hint) {
  problems_.push_back({place, std::move(message), std::move(hint)});
}

void TableReader::add_problem_at(std::string_view key, std::string message, std::string hint) {
  const TomlValue* found = table_.find(key);
  add_problem(found != nullptr ? found->place : table_.place, std::move(message), std::move(hint));
}

std::optional<double> TableReader::as_number(const TomlValue& value, const std::string& name,
                                             const Range& range) {
  const std::string unit = range.unit.empty() ? "" : fmt::format(" in {}", range.unit);
  if (value.kind != TomlKind::whole && value.kind != TomlKind::real) {
    add_problem(value.place,
                fmt::format("{} must be a number{}, but is {}", name, unit, kind_in_words(value)));
    return std::nullopt;
  }
  if (!std::isfinite(value.real)) {
    add_problem(value.place, fmt::format("{} must be finite, but is {}", name, value.real),
                fmt::format("write a number {}", describe(range)));
    return std::nullopt;
  }
  const bool too_small = range.least_is_open ? value.real <= range.least : value.real < range.least;
  if (too_small || value.real > range.most) {
    const bool is_beyond_all = value.real > range.most && range.most == kHuge;
    add_problem(value.place, fmt::format("{} must be {}, but is {:g}", name,
                                         is_beyond_all ? fmt::format("at most {:g}", kHuge) : describe(range),
                                         value.real));
    return std::nullopt;
  }
  return value.real;
}

std::optional<Vec3> TableReader::as_vector(const TomlValue& value, const std::string& name,
                                           const Range& range) {
  if (!value.is_array() || value.items.size() != 3) {
    add_problem(
        value.place, fmt::format("{} must be three numbers, but is {}", name, kind_in_words(value)),
        fmt::format("write [x, y, z]{}", range.unit.empty() ? "" : fmt::format(" in {}", range.unit)));
    return std::nullopt;
  }
  Vec3 vector = Vec3::Zero();
  constexpr std::array<const char*, 3> kAxes{"x", "y", "z"};
  bool is_good = true;
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    const auto number = as_number(value.items[i], fmt::format("{} of {}", kAxes[i], name), range);
    is_good = is_good && number.has_value();
    vector[axis] = number.value_or(0.0);
  }
  if (!is_good) return std::nullopt;
  return vector;
}

std::optional<double> TableReader::number(const std::string& key, const Range& range) {
  const TomlValue* value = find_known(key);
  if (value == nullptr) return std::nullopt;
  return as_number(*value, key, range);
}

std::optional<std::int64_t> TableReader::whole_number(const std::string& key, std::int64_t least,
                                                      std::int64_t most) {
  const TomlValue* value = find_known(key);
  if (value == nullptr) return std::nullopt;
  if (value->kind != TomlKind::whole) {
    add_problem(value->place,
                fmt::format("{} must be a whole number, but is {}", key, kind_in_words(*value)));
    return std::nullopt;
  }
  if (value->whole < least || value->whole > most) {
    add_problem(value->place,
                fmt::format("{} must be from {} to {}, but is {}", key, least, most, value->whole));
    return std::nullopt;
  }
  return value->whole;
}

std::optional<bool> TableReader::truth(const std::string& key) {
  const TomlValue* value = find_known(key);
  if (value == nullptr) return std::nullopt;
  if (value->kind != TomlKind::truth) {
    add_problem(value->place, fmt::format("{} must be true or false, but is {}", key, kind_in_words(*value)));
    return std::nullopt;
  }
  return value->truth;
}

std::optional<std::string> TableReader::text(const std::string& key) {
  const TomlValue* value = find_known(key);
  if (value == nullptr) return std::nullopt;
  if (!value->is_text()) {
    add_problem(value->place, fmt::format("{} must be a text, but is {}", key, kind_in_words(*value)),
                "write it in quotes");
    return std::nullopt;
  }
  return value->text;
}

std::optional<Vec3> TableReader::number_or_vector(const std::string& key, const Range& range) {
  const TomlValue* given = find_known(key);
  if (given == nullptr) return std::nullopt;
  if (given->is_array()) return as_vector(*given, key, range);
  if (const auto number = as_number(*given, key, range)) return Vec3::Constant(*number);
  return std::nullopt;
}

std::optional<Vec3> TableReader::vector(const std::string& key, const Range& range) {
  const TomlValue* value = find_known(key);
  if (value == nullptr) return std::nullopt;
  return as_vector(*value, key, range);
}

std::optional<std::string> TableReader::choice(const std::string& key,
                                               const std::vector<std::string>& choices) {
  const auto word = text(key);
  if (!word || contains(choices, *word)) return word;
  add_problem_at(key, fmt::format("unknown {} \"{}\"", key, *word),
                 hint_for_name(*word, choices, "available"));
  return std::nullopt;
}

void TableReader::foreign(const std::vector<std::string>& keys, const std::string& reason) {
  for (const std::string& key : keys) {
    const TomlValue* value = table_.find(key);
    if (value == nullptr || contains(known_, key) || contains(told_, key)) continue;
    told_.push_back(key);
    add_problem(value->key_place, fmt::format("{}: \"{}\" does not belong here", what_, key), reason);
  }
}

void TableReader::finish() {
  for (const auto& [key, value] : table_.entries) {
    if (contains(known_, key) || contains(told_, key)) continue;
    add_problem(value.key_place, fmt::format("{}: unknown key \"{}\"", what_, key),
                hint_for_name(key, known_, "keys here"));
  }
}

}  // namespace shatterbox::sandbox::scene
