// The import direction of the house: who may include whom. Read from the sources, so that a wrong arrow fails
// a test.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace shatterbox::structure {

struct SourceFile {
  std::string path;                   // from the root, with slashes: "engine/core/hash.h"
  std::vector<std::string> includes;  // what stands between quotes or angle brackets, in order
  bool has_pragma_once = false;
};

/// All .h and .cpp files below engine, render and sandbox of `root`, sorted by path. Comments are not read.
std::vector<SourceFile> read_sources(const std::filesystem::path& root);

/// A sentence for every include that goes up, sideways, or out of its house; for every header without #pragma
/// once.
std::vector<std::string> find_wrong_includes(const std::vector<SourceFile>& files);

/// A sentence for every circle of includes: "a.h -> b.h -> a.h".
std::vector<std::string> find_circles(const std::vector<SourceFile>& files);

/// A sentence for every .cpp that no CMakeLists.txt of its folder names, and every header that no file
/// includes.
std::vector<std::string> find_unreached(const std::filesystem::path& root,
                                        const std::vector<SourceFile>& files);

}  // namespace shatterbox::structure
