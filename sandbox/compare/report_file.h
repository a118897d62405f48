// Reports as files that anybody may have written: read in bounded time and memory, or refused in words.
#pragma once

#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "engine/core/result.h"

namespace shatterbox::sandbox::compare {

/// Whether a name is a report's: it ends in .json.
bool is_report_name(const std::string& name);

/// A report of `run`, `render` or of a film of several shots; else why it is none.
core::Result<nlohmann::ordered_json> parse_report(std::string_view text);
core::Result<nlohmann::ordered_json> read_report(const std::string& file);

}  // namespace shatterbox::sandbox::compare
