#include "sandbox/report/table_file.h"

#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace shatterbox::sandbox::report {

namespace {

std::string quoted_cell(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::string json_text(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

struct CsvCell {
  std::string operator()(std::monostate) const { return {}; }
  std::string operator()(long number) const { return fmt::format("{}", number); }
  std::string operator()(double number) const {
    return std::isfinite(number) ? fmt::format("{}", number) : "";
  }
  std::string operator()(const std::string& text) const { return quoted_cell(text); }
};

struct JsonCell {
  std::string operator()(std::monostate) const { return "null"; }
  std::string operator()(long number) const { return fmt::format("{}", number); }
  std::string operator()(double number) const {
    return std::isfinite(number) ? fmt::format("{}", number) : "null";
  }
  std::string operator()(const std::string& text) const { return json_text(text); }
};

}  // namespace

TableFile::TableFile(const std::string& folder, const std::string& name, const std::vector<Column>& columns)
    : csv_name_(fmt::format("{}/{}.csv", folder, name)),
      json_name_(fmt::format("{}/{}.json", folder, name)),
      csv_(csv_name_ + ".part", std::ios::binary),
      json_(json_name_ + ".part", std::ios::binary) {
  json_ << "{\"table\": " << json_text(name) << ",\n \"columns\": [";
  for (std::size_t i = 0; i < columns.size(); ++i) {
    csv_ << (i > 0 ? "," : "") << columns[i].name;
    json_ << (i > 0 ? ", " : "") << "{\"name\": " << json_text(columns[i].name)
          << ", \"unit\": " << json_text(columns[i].unit) << "}";
  }
  csv_ << '\n';
  json_ << "],\n \"rows\": [";
}

void TableFile::add_row(const std::vector<Cell>& cells) {
  json_ << (has_rows_ ? ",\n  [" : "\n  [");
  for (std::size_t i = 0; i < cells.size(); ++i) {
    csv_ << (i > 0 ? "," : "") << std::visit(CsvCell{}, cells[i]);
    json_ << (i > 0 ? ", " : "") << std::visit(JsonCell{}, cells[i]);
  }
  csv_ << '\n';
  json_ << ']';
  has_rows_ = true;
}

std::string TableFile::fault() const {
  if (csv_ && json_) return {};
  return fmt::format("{} cannot be written: {}", csv_ ? json_name_ : csv_name_, std::strerror(errno));
}

std::string TableFile::close() {
  errno = 0;
  json_ << "\n ]}\n";
  csv_.close();
  json_.close();
  if (std::string sentence = fault(); !sentence.empty()) return sentence;
  for (const std::string& name : {csv_name_, json_name_}) {
    std::error_code code;
    std::filesystem::rename(name + ".part", name, code);
    if (code) return fmt::format("{} cannot be written: {}", name, code.message());
  }
  return {};
}

}  // namespace shatterbox::sandbox::report
