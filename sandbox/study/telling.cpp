#include "sandbox/study/telling.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "sandbox/study/order.h"

namespace shatterbox::sandbox::study {

namespace {

/// An error with its unit: a share in percent, what is none as a number.
std::string error_text(const Table& table, double error) {
  if (std::isnan(error)) return "-";
  return table.is_relative ? percent(error) : fmt::format("{:.3g}", error);
}

/// Of an error behind the first, or a count.
std::string number_text(double number) {
  if (std::isnan(number)) return "-";
  const bool is_count = std::abs(number) < 1e7 && number == std::floor(number);
  return is_count ? fmt::format("{:.0f}", number) : fmt::format("{:.3g}", number);
}

double first_error(const Row& row) {
  return row.errors.empty() ? kNoNumber : std::abs(row.errors[0]);
}

/// "60 steps a second (0.31 %, 4 ms)".
std::string row_text(const Table& table, const Row& row) {
  const std::string cost = std::isnan(row.seconds) ? "" : ", " + time_text(row.seconds);
  return fmt::format("{} {} ({}{})", row.setting, table.setting_name, error_text(table, first_error(row)),
                     cost);
}

bool is_exact(const Table& table) {
  return !table.rows.empty() && std::all_of(table.rows.begin(), table.rows.end(),
                                            [](const Row& row) { return first_error(row) < 1e-12; });
}

std::string theory_text(const Table& table, std::size_t error) {
  if (error >= table.theory.size() || std::isnan(table.theory[error])) return "";
  return fmt::format("; theory: {:g}", table.theory[error]);
}

/// Orders of the errors behind the first, where theory has one.
std::string other_orders(const Table& table) {
  std::string text;
  for (std::size_t e = 1; e < table.theory.size(); ++e) {
    const auto order = fit_order(table, e);
    if (!order || theory_text(table, e).empty()) continue;
    text += fmt::format(" {}: {} {:.2f} over {} settings{}.", table.error_names[e], table.order_name,
                        order->order, order->rows.size(), theory_text(table, e));
  }
  return text;
}

std::string order_sentence(const Table& table) {
  if (table.rows.size() < 3 || table.value_name.empty()) return "";
  if (is_exact(table)) return "Right to rounding at every setting: there is no order to fit.";
  const auto order = fit_order(table, 0);
  if (!order) {
    double least = 1e300, most = 0.0;
    for (const Row& row : table.rows) {
      if (std::isnan(first_error(row))) continue;
      least = std::min(least, first_error(row));
      most = std::max(most, first_error(row));
    }
    return fmt::format("No {} is seen: the first column lies between {} and {}.{}", table.order_name,
                       error_text(table, least), error_text(table, most), other_orders(table));
  }
  std::string text =
      fmt::format("Observed {} {:.2f} over {} settings ({} to {} {}){}.", table.order_name, order->order,
                  order->rows.size(), table.rows[static_cast<std::size_t>(order->rows.front())].setting,
                  table.rows[static_cast<std::size_t>(order->rows.back())].setting, table.setting_name,
                  theory_text(table, 0));
  if (order->is_at_end) text += " Finer settings than these gain nothing.";
  return text + other_orders(table);
}

std::string default_sentence(const Table& table) {
  const auto place = default_row(table);
  if (!place) return "";
  const Row& row = table.rows[*place];
  std::string text = fmt::format("Default: {}", row_text(table, row));
  for (std::size_t e = 1; e < row.errors.size(); ++e)
    if (!std::isnan(row.errors[e]))
      text += fmt::format(", {} {}", table.error_names[e], number_text(row.errors[e]));
  return text + ".";
}

std::string cheapest_sentence(const Table& table) {
  if (!table.is_relative || table.rows.size() < 2) return "";
  std::string text;
  for (const double bound : {1e-2, 1e-3}) {
    const auto row = cheapest_row(table, bound);
    text += fmt::format("{} {}: {}", text.empty() ? "Cheapest for" : "; for", percent(bound),
                        row ? row_text(table, table.rows[*row]) : "none of these");
  }
  return text + ".";
}

std::string notes_sentence(const Table& table) {
  std::string text;
  for (const Row& row : table.rows)
    if (!row.note.empty()) text += fmt::format("{}{}: {}", text.empty() ? "" : "; ", row.setting, row.note);
  return text.empty() ? "" : "Noted: " + text + ".";
}

}  // namespace

std::string percent(double share) {
  const double p = 100.0 * share;
  if (p == 0.0) return "0 %";
  if (std::abs(p) >= 1000.0) return fmt::format("{:.3g} times", share);
  return std::abs(p) >= 0.01 ? fmt::format("{:.3g} %", p) : fmt::format("{:.1e} %", p);
}

std::string time_text(double seconds) {
  if (std::isnan(seconds)) return "-";
  if (seconds >= 0.995) return fmt::format("{:.3g} s", seconds);
  return seconds >= 1e-3 ? fmt::format("{:.3g} ms", 1e3 * seconds) : fmt::format("{:.3g} us", 1e6 * seconds);
}

std::string describe_table(const Table& table) {
  std::string text = fmt::format("{}: {}; error: {}.", table.name, table.what,
                                 table.error_names.empty() ? "none" : table.error_names[0]);
  for (const std::string& sentence :
       {order_sentence(table), default_sentence(table), cheapest_sentence(table), notes_sentence(table)})
    if (!sentence.empty()) text += " " + sentence;
  return text;
}

std::string describe(const StudyResult& result) {
  std::string text;
  for (const Table& table : result.tables)
    if (!table.rows.empty()) text += describe_table(table) + "\n\n";
  for (const std::string& sentence : result.conclusions) text += sentence + "\n";
  if (!result.is_whole) text += "Stopped before its end: what is missing was not measured.\n";
  return text;
}

std::string summary_rows(const StudyResult& result) {
  std::string text;
  for (const Table& table : result.tables) {
    const auto place = default_row(table);
    if (table.rows.empty() || !place) continue;
    const Row& row = table.rows[*place];
    const auto best = table.is_relative ? cheapest_row(table, 1e-2) : std::nullopt;
    const std::string cheapest = best ? fmt::format("{} {} ({})", table.rows[*best].setting,
                                                    table.setting_name, time_text(table.rows[*best].seconds))
                                      : (table.is_relative ? "none of these" : "-");
    text += fmt::format("| {} | {} | {} ({}) | {} | {} |\n", table.name, table.what,
                        error_text(table, first_error(row)), table.error_names[0], time_text(row.seconds),
                        cheapest);
  }
  return text;
}

std::string to_markdown(const StudyResult& result, const std::string& name, const std::string& what) {
  const char* stop = what.ends_with('.') ? "" : ".";  // a scene's goal is a sentence
  std::string text = fmt::format("## {}\n\n{}{}\n\n<!-- summary -->\n{}<!-- end of summary -->\n\n", name,
                                 what, stop, summary_rows(result));
  const bool is_drawn = std::any_of(result.tables.begin(), result.tables.end(),
                                    [](const Table& table) { return table.is_plotted; });
  if (is_drawn) text += fmt::format("![error against run time]({}.png)\n\n", name);
  for (const Figure& figure : result.figures)
    text += fmt::format("![{}]({}_{}.png)\n\n", figure.title, name, figure.name);
  for (const std::string& sentence : result.conclusions) text += sentence + "\n\n";
  for (const Table& table : result.tables)
    if (!table.rows.empty())
      text += fmt::format("### {}\n\n{}\n\n{}\n", table.name, describe_table(table), markdown_rows(table));
  return text;
}

std::string markdown_rows(const Table& table) {
  std::string text = fmt::format("| {} |", table.setting_name), rule = "|---|";
  for (const std::string& name : table.error_names) {
    text += fmt::format(" {} |", name);
    rule += "---|";
  }
  text += " time |\n" + rule + "---|\n";
  for (const Row& row : table.rows) {
    text += fmt::format("| {}{} |", row.setting, row.is_default ? " (default)" : "");
    for (std::size_t e = 0; e < row.errors.size(); ++e)
      text += fmt::format(" {} |", e == 0 ? error_text(table, row.errors[e]) : number_text(row.errors[e]));
    text += fmt::format(" {} |\n", time_text(row.seconds));
  }
  return text;
}

}  // namespace shatterbox::sandbox::study
