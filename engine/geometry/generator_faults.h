// What is wrong with the sizes that a generated mesh is asked for. For the generators.
#pragma once

#include <optional>
#include <string>

#include "engine/core/result.h"
#include "engine/geometry/generators.h"

namespace shatterbox::geometry {

/// "0.1 m".
std::string metres(double value);

/// "a sphere's radius must be greater than 0 m (it is -1 m)", or nothing. m. `what_is_least` is told before
/// the least size.
std::optional<std::string> find_size_fault(const std::string& what, double value, double least = 0.0,
                                           const std::string& what_is_least = "");

core::Error too_fine(const Meshing& meshing);

}  // namespace shatterbox::geometry
