// The verb `diff`: two pictures, folders of pictures or videos side by side.
#pragma once

#include <string>

namespace shatterbox::sandbox::run {

struct DiffOptions {
  std::string expected, actual;
  std::string tolerance = "default";
  std::string report;           // JSON
  std::string junit;            // XML
  std::string picture;          // PNG of the worst frame's difference
  std::string pictures_folder;  // one for every frame that differs
};

/// Compares, says what it found, writes what was asked for. Returns the exit status.
int run_diff(const DiffOptions& options);

}  // namespace shatterbox::sandbox::run
