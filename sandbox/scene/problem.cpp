#include "sandbox/scene/problem.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace shatterbox::sandbox::scene {

void book(Problems& problems, Place place, std::string message, std::string hint) {
  problems.push_back({std::move(place), std::move(message), std::move(hint)});
}

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
  for (const Problem& problem : problems) {
    if (!text.empty()) text += '\n';
    text += describe(problem);
  }
  return text;
}

}  // namespace shatterbox::sandbox::scene
