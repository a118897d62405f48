#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>

#include <fmt/format.h>

#include "sandbox/study/telling.h"

namespace shatterbox::sandbox::study {

namespace {

const std::vector<std::string> kFixedColumns{"table", "setting", "value", "default", "seconds", "note"};

std::string cell(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::string cell(double number) {
  return std::isnan(number) ? "" : fmt::format("{:.17g}", number);
}

double number_of(const std::string& text) {
  return text.empty() ? kNoNumber : std::strtod(text.c_str(), nullptr);
}

/// The cells of all lines; a quoted cell may hold commas, quotes and ends of lines.
std::vector<std::vector<std::string>> split_cells(const std::string& text) {
  std::vector<std::vector<std::string>> lines(1, std::vector<std::string>(1));
  bool is_quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    std::string& last = lines.back().back();
    if (c == '"') {
      if (is_quoted && i + 1 < text.size() && text[i + 1] == '"') {
        last += text[++i];
      } else {
        is_quoted = !is_quoted;
      }
    } else if (!is_quoted && c == ',') {
      lines.back().emplace_back();
    } else if (!is_quoted && c == '\n') {
      lines.emplace_back(1);
    } else {
      last += c;
    }
  }
  if (lines.back().size() == 1 && lines.back()[0].empty()) lines.pop_back();
  return lines;
}

std::vector<std::string> all_error_names(const std::vector<Table>& tables) {
  std::vector<std::string> names;
  for (const Table& table : tables)
    for (const std::string& name : table.error_names)
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  return names;
}

}  // namespace

std::string to_csv(const std::vector<Table>& tables) {
  const std::vector<std::string> names = all_error_names(tables);
  std::string text;
  for (const std::string& name : kFixedColumns) text += (text.empty() ? "" : ",") + name;
  for (const std::string& name : names) text += fmt::format(",{}", cell(name));
  text += "\n";
  for (const Table& table : tables)
    for (const Row& row : table.rows) {
      text += fmt::format("{},{},{},{},{},{}", cell(table.name), cell(row.setting), cell(row.value),
                          row.is_default ? 1 : 0, cell(row.seconds), cell(row.note));
      for (const std::string& name : names) {
        const auto found = std::find(table.error_names.begin(), table.error_names.end(), name);
        const auto place = static_cast<std::size_t>(found - table.error_names.begin());
        text += fmt::format(",{}", place < row.errors.size() ? cell(row.errors[place]) : "");
      }
      text += "\n";
    }
  return text;
}

std::optional<std::vector<Table>> from_csv(const std::string& text) {
  const auto lines = split_cells(text);
  const std::size_t fixed = kFixedColumns.size();
  if (lines.empty() || lines[0].size() < fixed ||
      !std::equal(kFixedColumns.begin(), kFixedColumns.end(), lines[0].begin()))
    return std::nullopt;
  const std::vector<std::string>& head = lines[0];
  std::vector<Table> tables;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const std::vector<std::string>& line = lines[i];
    if (line.size() != head.size()) return std::nullopt;
    if (tables.empty() || tables.back().name != line[0]) {
      tables.emplace_back();
      tables.back().name = line[0];
      // A table has the errors of which its first row has a number.
      for (std::size_t k = fixed; k < head.size(); ++k)
        if (!line[k].empty()) tables.back().error_names.push_back(head[k]);
    }
    Table& table = tables.back();
    Row row;
    row.setting = line[1];
    row.value = number_of(line[2]);
    row.is_default = line[3] == "1";
    row.seconds = number_of(line[4]);
    row.note = line[5];
    for (const std::string& name : table.error_names) {
      const auto found = std::find(head.begin() + static_cast<std::ptrdiff_t>(fixed), head.end(), name);
      row.errors.push_back(number_of(line[static_cast<std::size_t>(found - head.begin())]));
    }
    table.rows.push_back(std::move(row));
  }
  return tables;
}

}  // namespace shatterbox::sandbox::study
