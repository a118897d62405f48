#include "tests/structure/local_names.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <regex>

namespace shatterbox::structure {
namespace {

struct Definition {
  std::string file;
  std::string alias;  // the whole line, where it is one
};

using Definitions = std::map<std::string, std::vector<Definition>>;  // by namespace and name

std::vector<std::filesystem::path> sources_below(const std::filesystem::path& root) {
  std::vector<std::filesystem::path> files;
  for (const char* house : {"engine", "render", "sandbox", "tests"}) {
    if (!std::filesystem::exists(root / house)) continue;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / house))
      if (entry.path().extension() == ".cpp") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// Adds what a file defines at the start of a line, as clang-format leaves it, in an unnamed namespace.
void read_definitions(const std::filesystem::path& path, const std::string& name, Definitions& definitions) {
  static const std::regex opening(R"(namespace ?([\w:]*) ?\{)"), closing(R"(\}  // namespace.*)"),
      constant(R"((?:inline |static )?(?:constexpr|const) [^=({;]*?\b(k[A-Z]\w*)\b.*)"),
      type(R"((?:struct|class|enum class|enum) (\w+)[^;]*\{.*)"), alias(R"(using (\w+) =.*)");
  std::ifstream file(path);
  std::vector<std::string> scopes;
  std::string line;
  while (std::getline(file, line)) {
    std::smatch match;
    if (std::regex_match(line, match, opening)) {
      scopes.push_back(match[1]);
    } else if (std::regex_match(line, closing)) {
      if (!scopes.empty()) scopes.pop_back();
    } else if (std::find(scopes.begin(), scopes.end(), "") != scopes.end()) {
      const bool is_alias = std::regex_match(line, match, alias);
      if (!is_alias && !std::regex_match(line, match, constant) && !std::regex_match(line, match, type))
        continue;
      std::string key;
      if (name.starts_with("tests/"))
        key = name.substr(0, name.rfind('/')) + "/";  // all in the outermost one
      for (const std::string& scope : scopes) key += scope.empty() ? "" : scope + "::";
      definitions[key + match[1].str()].push_back({name, is_alias ? line : ""});
    }
  }
}

}  // namespace

std::vector<std::string> find_shared_local_names(const std::filesystem::path& root) {
  Definitions definitions;
  for (const std::filesystem::path& path : sources_below(root))
    read_definitions(path, std::filesystem::relative(path, root).generic_string(), definitions);
  std::vector<std::string> sentences;
  for (const auto& [name, places] : definitions)
    for (std::size_t i = 1; i < places.size(); ++i) {
      const Definition &first = places[0], &again = places[i];
      if (first.file == again.file || (!first.alias.empty() && first.alias == again.alias)) continue;
      sentences.push_back(name + " is defined by " + first.file + " and by " + again.file);
    }
  return sentences;
}

}  // namespace shatterbox::structure
