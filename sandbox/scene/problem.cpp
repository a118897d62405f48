#include "sandbox/scene/problem.h"

#include <algorithm>
#include <tuple>

namespace shatterbox::sandbox::scene {

std::string describe(const Place& place) {
  if (place.line <= 0) return place.file;
  return place.file + ":" + std::to_string(place.line) + ":" + std::to_string(place.column);
}

std::string describe(const Problem& problem) {
  std::string text = describe(problem.place) + ": " + problem.message;
  if (!problem.hint.empty()) text += "\n    " + problem.hint;
  return text;
}

std::string describe(Problems problems) {
  const auto key = [](const Problem& p) {
    return std::tie(p.place.file, p.place.line, p.place.column, p.message, p.hint);
  };
  std::stable_sort(problems.begin(), problems.end(),
                   [&key](const Problem& a, const Problem& b) { return key(a) < key(b); });
  problems.erase(std::unique(problems.begin(), problems.end(),
                             [&key](const Problem& a, const Problem& b) { return key(a) == key(b); }),
                 problems.end());
  std::string text;
  for (const Problem& problem : problems) text += (text.empty() ? "" : "\n") + describe(problem);
  return text;
}

}  // namespace shatterbox::sandbox::scene
