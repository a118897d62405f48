#include "sandbox/compare/trace_difference.h"

#include <algorithm>
#include <map>
#include <sstream>
#include <utility>

#include <fmt/format.h>

namespace shatterbox::sandbox::compare {

namespace {

using Json = nlohmann::ordered_json;

const Json& list_of(const Json& trace, const char* name) {
  static const Json kNone = Json::array();
  if (!trace.is_object()) return kNone;
  const auto found = trace.find(name);
  return found != trace.end() && found->is_array() ? *found : kNone;
}

std::string word(const Json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

/// [step, part, parts, pass, stage, changed], as sandbox/report writes it.
constexpr std::size_t kRowLength = 6;

bool is_row(const Json& row) {
  return row.is_array() && row.size() == kRowLength;
}

std::string describe_stage(const Json& row) {
  if (!is_row(row)) return "nothing";
  return fmt::format("stage {} (part {} of {}, pass {})", word(row[4]), row[1].dump(), row[2].dump(),
                     row[3].dump());
}

/// Hashes by body and quantity, from "17 0:1a2b3c4d 2:5e6f7a8b;18 0:..".
using Changes = std::map<std::pair<long, long>, std::string>;

Changes parse_changes(const std::string& text) {
  Changes changes;
  std::istringstream bodies(text);
  for (std::string body; std::getline(bodies, body, ';');) {
    std::istringstream words(body);
    long id = 0, place = 0;
    words >> id;
    char colon = 0;
    for (std::string hash; words >> place >> colon >> hash;) changes[{id, place}] = hash;
  }
  return changes;
}

std::string name_body(const Json& trace, long id) {
  if (id == 0) return "all bodies together";
  const auto names = trace.find("names");
  const std::string number = std::to_string(id);
  if (names == trace.end() || !names->is_object() || !names->contains(number)) return "body " + number;
  return fmt::format("body {} \"{}\"", number, word((*names)[number]));
}

std::string name_quantity(const Json& trace, long place) {
  const Json& names = list_of(trace, "quantities");
  return place >= 0 && static_cast<std::size_t>(place) < names.size()
             ? word(names[static_cast<std::size_t>(place)])
             : fmt::format("quantity {}", place);
}

/// Of two rows of one stage whose changes are not the same. Bodies go before what is between them.
ValueDifference compare_changes(const std::string& where, const Json& expected, const Json& actual,
                                const Json& row_a, const Json& row_b) {
  const Changes a = parse_changes(word(row_a[5])), b = parse_changes(word(row_b[5]));
  std::map<long, std::pair<long, std::pair<std::string, std::string>>> parted;  // by body: the first quantity
  const auto look = [&parted](const Changes& one, const Changes& other, bool is_turned) {
    for (const auto& [key, hash] : one) {
      const auto found = other.find(key);
      const std::string there = found != other.end() ? found->second : "unchanged";
      if (there == hash) continue;
      const std::pair parting(key.second, is_turned ? std::pair(there, hash) : std::pair(hash, there));
      const auto [entry, is_new] = parted.try_emplace(key.first, parting);
      if (!is_new && key.second < entry->second.first) entry->second = parting;
    }
  };
  look(a, b, false);
  look(b, a, true);
  if (parted.empty()) return {where, word(row_a[5]), word(row_b[5]), std::nullopt};
  auto first = parted.begin();
  if (first->first == 0 && parted.size() > 1) ++first;
  const long id = first->first;
  const auto others = std::count_if(parted.begin(), parted.end(), [id](const auto& entry) {
    return entry.first != 0 && entry.first != id;
  });
  const auto& [place, hashes] = first->second;
  const Json& named =
      expected.contains("names") && expected["names"].contains(std::to_string(id)) ? expected : actual;
  std::string text = fmt::format("{}, {}, {}", where, name_body(named, id), name_quantity(expected, place));
  if (others > 0) text += fmt::format(" (and {} more bod{})", others, others == 1 ? "y" : "ies");
  return {text, hashes.first, hashes.second, std::nullopt};
}

}  // namespace

std::optional<ValueDifference> find_first_difference(const Json& expected, const Json& actual) {
  const Json &a = list_of(expected, "rows"), &b = list_of(actual, "rows");
  for (std::size_t i = 0; i < std::max(a.size(), b.size()); ++i) {
    static const Json kNone;
    const Json &one = i < a.size() ? a[i] : kNone, &other = i < b.size() ? b[i] : kNone;
    if (one == other) continue;
    const std::string step = fmt::format("step {}", is_row(one)     ? one[0].dump()
                                                    : is_row(other) ? other[0].dump()
                                                                    : "?");
    const bool is_one_stage =
        is_row(one) && is_row(other) && std::equal(one.begin(), one.begin() + kRowLength - 1, other.begin());
    if (!is_one_stage) return ValueDifference{step, describe_stage(one), describe_stage(other), std::nullopt};
    return compare_changes(step + ", " + describe_stage(one), expected, actual, one, other);
  }
  return std::nullopt;
}

}  // namespace shatterbox::sandbox::compare
