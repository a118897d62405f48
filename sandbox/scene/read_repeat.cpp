#include <algorithm>
#include <span>

#include <fmt/format.h>

#include "sandbox/scene/read_body.h"

namespace shatterbox::sandbox::scene {

namespace {

/// `count` whole numbers from 1 to 100000, or nothing after booking what is wrong.
bool read_whole_numbers(TableReader& reader, const TomlValue& value, const std::string& name,
                        std::span<int> numbers) {
  if (!value.is_array() || value.items.size() != numbers.size()) {
    reader.add_problem(value.place,
                       fmt::format("{} must be a list of {} whole numbers", name, numbers.size()));
    return false;
  }
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const TomlValue& item = value.items[i];
    if (item.kind != TomlKind::whole || item.whole < 1 || item.whole > kMostCopies) {
      reader.add_problem(item.place, fmt::format("{} must be from 1 to {}, but is {}", name, kMostCopies,
                                                 kind_in_words(item)));
      return false;
    }
    numbers[i] = static_cast<int>(item.whole);
  }
  return true;
}

void read_count(TableReader& reader, Repeat& repeat) {
  if (const TomlValue* count = reader.value("count"); count != nullptr && count->is_array()) {
    repeat.layout = Layout::grid;
    read_whole_numbers(reader, *count, "count", repeat.count);
  } else if (const auto whole = reader.whole_number("count", 1, kMostCopies)) {
    repeat.count[0] = static_cast<int>(*whole);
  } else if (count == nullptr) {
    reader.add_problem(reader.table().place, "repeat needs a count",
                       "write repeat = {count = 10, spacing = [0.1, 0, 0]}");
  }
  if (static_cast<double>(repeat.count[0]) * repeat.count[1] * repeat.count[2] > kMostCopies) {
    reader.add_problem_at("count", fmt::format("more than {} copies", kMostCopies));
    repeat.count = {1, 1, 1};
  }
  const TomlValue* layer = reader.value("layer");
  if (layer == nullptr || !read_whole_numbers(reader, *layer, "layer", repeat.layer)) return;
  if (repeat.layout == Layout::grid) {
    reader.add_problem(layer->place, "a grid has no layers", "write count = 100, layer = [5, 5]");
  }
  if (static_cast<double>(repeat.layer[0]) * repeat.layer[1] > kMostCopies) {
    reader.add_problem(layer->place, fmt::format("more than {} copies in a layer", kMostCopies));
    repeat.layer = {1, 1};
  }
  repeat.layout = Layout::layers;
}

}  // namespace

Repeat read_repeat(TableReader& reader) {
  Repeat repeat;
  const TomlValue* value = reader.value("repeat");
  if (value == nullptr) return repeat;
  if (!value->is_table()) {
    reader.add_problem(value->place, fmt::format("repeat must be a table, but is {}", kind_in_words(*value)),
                       "write repeat = {count = 10, spacing = [0.1, 0, 0]}");
    return repeat;
  }
  TableReader inner(*value, reader.what() + ".repeat", reader.problems());
  read_count(inner, repeat);
  repeat.spacing = inner.number_or_vector("spacing", any_number("m")).value_or(repeat.spacing);
  if (inner.has("jitter"))
    repeat.jitter = inner.number_or_vector("jitter", not_negative("m")).value_or(repeat.jitter);
  repeat.rotation_jitter = inner.number("rotation_jitter", between(0.0, 180.0, "degrees")).value_or(0.0);
  repeat.every = inner.number("every", between(0.0, 1e6, "s")).value_or(0.0);
  repeat.bond = inner.number("bond", between(0.0, 1.0)).value_or(0.0);
  if (inner.has("bond") && repeat.layout != Layout::grid)
    inner.add_problem_at("bond", "only courses of a grid have a bond", "write count = [12, 10, 1]");
  inner.finish();
  return repeat;
}

}  // namespace shatterbox::sandbox::scene
