// The known name that a mistyped one is nearest to.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace shatterbox::sandbox::scene {

/// Number of single-letter insertions, removals, replacements and swaps of neighbours that make `b` of `a`
/// (optimal string alignment).
int edit_distance(std::string_view a, std::string_view b);

/// The name in `known` that other programs call `name`, else the one with the least edit distance to it (the
/// earliest of equals), capitals ignored; empty when none is near enough to have been meant (more than a
/// third of its letters wrong, at least two allowed).
std::string nearest_name(std::string_view name, const std::vector<std::string>& known);

/// A hint: "did you mean "x"?" if a name is near, and in any case the list of all known names.
std::string hint_for_name(std::string_view name, const std::vector<std::string>& known,
                          std::string_view what);

/// "a, b, c" with quotes around each.
std::string quoted_list(const std::vector<std::string>& names);

}  // namespace shatterbox::sandbox::scene
