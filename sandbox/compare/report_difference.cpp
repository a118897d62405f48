#include "sandbox/compare/report_difference.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "sandbox/compare/trace_difference.h"

namespace shatterbox::sandbox::compare {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostTold = 20;  // values, in words

bool is_one_of(const std::string& name, std::initializer_list<const char*> names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// What a machine, a day and the names of files make of it.
bool is_of_the_machine(const std::string& name) {
  return is_one_of(name, {"time_ms", "load_ms", "wall_seconds", "peak_memory_mb", "threads", "kept_frames",
                          "bytes", "version", "compiler", "gl_renderer", "recording", "recorded_by"});
}

/// What is another number as soon as anything is rounded otherwise.
bool is_of_rounding(const std::string& name) {
  return is_one_of(name, {"state_hash", "frame_hashes", "worst_residual", "contact_residual", "mass_error",
                          "momentum_error", "angular_momentum_error", "momentum_error_ns", "energy_gain"});
}

double relative_difference(double a, double b) {
  const double most = std::max(std::abs(a), std::abs(b));
  return most > 0.0 ? std::abs(a - b) / most : 0.0;
}

std::string words_of(const Json& value) {
  if (value.is_array()) return fmt::format("{} entries", value.size());
  return value.is_object() ? "a table" : value.dump();
}

class Comparison {
 public:
  Comparison(double tolerance, FieldDifference& found) : tolerance_(tolerance), found_(found) {}

  bool is_aside(const std::string& name) const {
    return is_of_the_machine(name) || (tolerance_ > 0.0 && is_of_rounding(name));
  }

  void compare(const std::string& place, const Json& a, const Json& b) {
    if (a.is_object() && b.is_object()) return compare_tables(place, a, b);
    if (a.is_array() && b.is_array()) return compare_lists(place, a, b);
    ++found_.compared;
    if (a.is_number() && b.is_number()) return compare_numbers(place, a, b);
    if (!is_same_word(place, a, b))
      found_.differences.push_back({place, words_of(a), words_of(b), std::nullopt});
  }

  void tell_missing(const std::string& place, const Json* a, const Json* b) {
    ++found_.compared;
    const auto words = [](const Json* value) { return value != nullptr ? words_of(*value) : "nothing"; };
    found_.differences.push_back({place, words(a), words(b), std::nullopt});
  }

 private:
  /// A verdict is a word and, behind a colon, its ratio, which has a field of its own.
  bool is_same_word(const std::string& place, const Json& a, const Json& b) const {
    if (a == b) return true;
    if (tolerance_ == 0.0 || !a.is_string() || !b.is_string() || !place.ends_with(".verdict")) return false;
    const auto word = [](const Json& text) {
      const auto whole = text.get<std::string>();
      return whole.substr(0, whole.find(':'));
    };
    return word(a) == word(b);
  }

  void compare_tables(const std::string& place, const Json& a, const Json& b) {
    for (const auto& [name, value] : a.items()) {
      if (is_aside(name)) continue;
      const auto other = b.find(name);
      if (other == b.end())
        tell_missing(place + "." + name, &value, nullptr);
      else
        compare(place + "." + name, value, *other);
    }
    for (const auto& [name, value] : b.items())
      if (!is_aside(name) && !a.contains(name)) tell_missing(place + "." + name, nullptr, &value);
  }

  void compare_lists(const std::string& place, const Json& a, const Json& b) {
    if (a.size() != b.size()) tell_missing(place, &a, &b);
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
      compare(fmt::format("{}[{}]", place, i), a[i], b[i]);
  }

  void compare_numbers(const std::string& place, const Json& a, const Json& b) {
    if (a == b) return;
    const double relative = relative_difference(a.get<double>(), b.get<double>());
    if (tolerance_ == 0.0 || relative > tolerance_)
      found_.differences.push_back({place, words_of(a), words_of(b), relative});
  }

  double tolerance_;
  FieldDifference& found_;
};

std::string in_words(const ValueDifference& value) {
  const std::string relative =
      value.relative ? fmt::format(" ({:.3g} %)", 100.0 * *value.relative) : std::string();
  return fmt::format("{}: {} and {}{}", value.place, value.expected, value.actual, relative);
}

/// One value: where they part. A run need not be traced, and with a tolerance its bits may differ.
void compare_traces(const std::string& name, const Json* a, const Json* b, ReportDifference& difference) {
  if (a == nullptr || b == nullptr || difference.tolerance > 0.0) return;
  FieldDifference field{name, 1, {}};
  if (auto first = find_first_difference(*a, *b)) {
    if (name != "trace") first->place = name.substr(0, name.find('.')) + ", " + first->place;
    field.differences.push_back(std::move(*first));
  }
  difference.fields.push_back(std::move(field));
}

bool is_trace(const FieldDifference& field) {
  return field.name.ends_with("trace");
}

/// Which state is another one first, if the reports can tell.
std::string tell_parting(const ReportDifference& difference) {
  bool is_traced = false, has_other_state = false;
  for (const FieldDifference& field : difference.fields) {
    is_traced |= is_trace(field);
    has_other_state |= field.name.ends_with("state_hash") && !field.differences.empty();
    if (is_trace(field) && !field.differences.empty())
      return fmt::format("    first    {}\n", in_words(field.differences.front()));
  }
  if (is_traced || !has_other_state) return {};
  return "    run both with --trace to learn in which step, stage and body they first differ\n";
}

/// The fields of one report, each under its own name.
void compare_fields(const std::string& prefix, const Json& a, const Json& b, ReportDifference& difference) {
  const auto compare_field = [&](const std::string& name, const Json* one, const Json* other) {
    if (name == "trace") return compare_traces(prefix + name, one, other, difference);
    FieldDifference field{prefix + name, 0, {}};
    Comparison comparison(difference.tolerance, field);
    if (comparison.is_aside(name)) return;
    if (one != nullptr && other != nullptr)
      comparison.compare(field.name, *one, *other);
    else
      comparison.tell_missing(field.name, one, other);
    difference.fields.push_back(std::move(field));
  };
  for (const auto& [name, value] : a.items())
    if (name != "shots") compare_field(name, &value, b.contains(name) ? &b[name] : nullptr);
  for (const auto& [name, value] : b.items())
    if (name != "shots" && !a.contains(name)) compare_field(name, nullptr, &value);
}

const Json& shots_of(const Json& report) {
  static const Json kNone = Json::array();
  const auto shots = report.find("shots");
  return shots != report.end() ? *shots : kNone;
}

}  // namespace

bool ReportDifference::is_same() const {
  return differing() == 0;
}

long ReportDifference::compared() const {
  return std::accumulate(fields.begin(), fields.end(), 0L,
                         [](long sum, const FieldDifference& field) { return sum + field.compared; });
}

long ReportDifference::differing() const {
  return std::accumulate(fields.begin(), fields.end(), 0L, [](long sum, const FieldDifference& field) {
    return sum + static_cast<long>(field.differences.size());
  });
}

std::optional<double> parse_report_tolerance(const std::string& text, std::string& problem) {
  if (text == "default" || text == "exact") return 0.0;
  double number = 0.0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (fault == std::errc() && end == text.data() + text.size() && number >= 0.0 && number < 1.0)
    return number;
  problem = fmt::format(
      "\"{}\" is no tolerance of reports; write exact, or the relative difference that numbers may have, "
      "from 0 "
      "to below 1, for example 0.01",
      text);
  return std::nullopt;
}

ReportDifference compare_reports(const Json& expected, const Json& actual, double tolerance) {
  ReportDifference difference{tolerance, {}};
  compare_fields("", expected, actual, difference);
  const Json &a = shots_of(expected), &b = shots_of(actual);
  if (a.size() != b.size()) {
    FieldDifference& field = difference.fields.emplace_back(FieldDifference{"shots", 0, {}});
    Comparison(tolerance, field).tell_missing("shots", &a, &b);
  }
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    compare_fields(fmt::format("shots[{}].", i), a[i], b[i], difference);
  return difference;
}

std::string describe(const ReportDifference& difference) {
  const long differing = difference.differing();
  if (differing == 0)
    return fmt::format("reports: the same in {} values{}\n", difference.compared(),
                       difference.tolerance > 0.0 ? ", within the tolerance" : "");
  std::string text = fmt::format("reports: {} of {} values differ{}\n", differing, difference.compared(),
                                 differing == 1 ? "s" : "");
  text += tell_parting(difference);
  std::size_t told = 0;
  const ValueDifference* greatest = nullptr;
  for (const FieldDifference& field : difference.fields) {
    if (is_trace(field)) continue;
    for (const ValueDifference& value : field.differences) {
      if (told++ < kMostTold) text += fmt::format("    {}\n", in_words(value));
      if (value.relative && (greatest == nullptr || *value.relative > *greatest->relative)) greatest = &value;
    }
  }
  if (told > kMostTold) text += fmt::format("    and {} more; --report FILE lists all\n", told - kMostTold);
  if (greatest != nullptr) text += fmt::format("    by most  {}\n", in_words(*greatest));
  return text;
}

Json make_json(const ReportDifference& difference) {
  Json json;
  json["same"] = difference.is_same();
  json["tolerance"] = difference.tolerance;
  json["values_compared"] = difference.compared();
  json["values_differing"] = difference.differing();
  json["differences"] = Json::array();
  for (const FieldDifference& field : difference.fields)
    for (const ValueDifference& value : field.differences)
      json["differences"].push_back({{"place", value.place},
                                     {"expected", value.expected},
                                     {"actual", value.actual},
                                     {"relative", value.relative ? Json(*value.relative) : Json(nullptr)}});
  return json;
}

std::vector<TestCase> test_cases(const ReportDifference& difference) {
  std::vector<TestCase> cases;
  for (const FieldDifference& field : difference.fields) {
    std::string failure;
    if (!field.differences.empty()) failure = in_words(field.differences.front());
    if (field.differences.size() > 1) failure += fmt::format(", and {} more", field.differences.size() - 1);
    cases.push_back({field.name, failure});
  }
  return cases;
}

}  // namespace shatterbox::sandbox::compare
