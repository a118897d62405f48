// Where two traces part.
#pragma once

#include <optional>

#include <nlohmann/json.hpp>

#include "sandbox/compare/report_difference.h"

namespace shatterbox::sandbox::compare {

/// The first row of two reports' traces in which something is another: the step, stage, body and quantity as
/// its place, and the hashes; nothing if the traces are the same.
std::optional<ValueDifference> find_first_difference(const nlohmann::ordered_json& expected,
                                                     const nlohmann::ordered_json& actual);

}  // namespace shatterbox::sandbox::compare
