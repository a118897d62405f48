// Whole files of text.
#pragma once

#include <string>

namespace shatterbox::sandbox::report {

/// Writes it beside its name and renames it: no half a file is ever found under the name. A sentence if that
/// fails, else empty.
std::string write_text(const std::string& path, const std::string& text);

/// Everything in a file; empty if it cannot be read.
std::string read_text(const std::string& path);

}  // namespace shatterbox::sandbox::report
