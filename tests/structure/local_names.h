// Names that are a file's own. run.sh compiles up to eight files of a library as one, so no two files of one
// namespace may have a constant or a type of their own under one name, not even in unnamed namespaces.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace shatterbox::structure {

/// A sentence for every constant (kName) and type that two .cpp files below engine, render and sandbox of
/// `root` define in unnamed namespaces of one named namespace, or two of one folder below tests. An alias of
/// one and the same type may stand in both; functions are not read, for they may be overloads.
std::vector<std::string> find_shared_local_names(const std::filesystem::path& root);

}  // namespace shatterbox::structure
