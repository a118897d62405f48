// A study's result as text: the CSV, and a paragraph that says what the numbers say.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sandbox/study/study.h"

namespace shatterbox::sandbox::study {

/// One line a row: table, setting, value, default (1 or 0), seconds, note, then every error name of the
/// study; empty where a table does not have it. Numbers with 17 digits, NaN as an empty cell, quotes where
/// needed.
std::string to_csv(const std::vector<Table>& tables);

/// Tables from such a text, with rows and error names; nothing if it is none.
std::optional<std::vector<Table>> from_csv(const std::string& text);

/// What one table says: the observed order, the default's place, the cheapest setting for 1 % and 0.1 %, what
/// was active.
std::string describe_table(const Table& table);

/// All of it: one paragraph a table, and the conclusions.
std::string describe(const StudyResult& result);

/// A summary as a table in Markdown: what, our error at the default, its cost, the cheapest setting for 1 %.
std::string summary_rows(const StudyResult& result);

/// All rows of a table in Markdown.
std::string markdown_rows(const Table& table);

/// The whole study as a page: its summary between two marks, its pictures (NAME.png, NAME_FIGURE.png), and of
/// each table the paragraph and the rows.
std::string to_markdown(const StudyResult& result, const std::string& name, const std::string& what);

/// "0.12 %" of a share; scientific below a hundredth of a percent, "12 times" from ten on.
std::string percent(double share);
/// "12 ms" of seconds.
std::string time_text(double seconds);

}  // namespace shatterbox::sandbox::study
