// A table as it grows, written twice: NAME.csv and NAME.json. Numbers read back to the same bits.
#pragma once

#include <fstream>
#include <string>
#include <variant>
#include <vector>

namespace shatterbox::sandbox::report {

struct Column {
  const char* name;  // ends with its unit: "x_m"
  const char* unit;  // "1" for none, "" for what is no number
};

/// Nothing, a whole number, a number (nan and infinity are nothing) or a text.
using Cell = std::variant<std::monostate, long, double, std::string>;

class TableFile {
 public:
  /// Files FOLDER/NAME.csv and .json, which until close() are called .part.
  TableFile(const std::string& folder, const std::string& name, const std::vector<Column>& columns);

  void add_row(const std::vector<Cell>& cells);

  /// A sentence if a file could not be written, else empty.
  std::string fault() const;
  std::string close();

 private:
  std::string csv_name_, json_name_;
  std::ofstream csv_, json_;
  bool has_rows_ = false;
};

}  // namespace shatterbox::sandbox::report
