// The report as JSON: field names as sandbox/README.md lists them.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "sandbox/report/run_record.h"

namespace shatterbox::sandbox::report {

inline constexpr int kReportVersion = 1;

/// The whole report; numbers that are not finite become null.
nlohmann::ordered_json make_json(const RunRecord& record);

/// {"median", "p95", "max"}.
nlohmann::ordered_json make_spread(const std::vector<double>& values);

/// Each by its name.
nlohmann::ordered_json make_spreads(const TimesByName& times);

/// Writes it beside its name and renames it; of several shots of one film a list of theirs. A sentence if
/// that fails, else empty.
std::string write_report(const std::string& path, const std::vector<const RunRecord*>& shots);

/// 16 lower-case hex digits.
std::string hex_digits(std::uint64_t number);

}  // namespace shatterbox::sandbox::report
