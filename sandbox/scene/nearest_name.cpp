#include "sandbox/scene/nearest_name.h"

#include <algorithm>

namespace shatterbox::sandbox::scene {

namespace {

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return lower;
}

/// What is called otherwise elsewhere.
struct OtherWords {
  std::string_view ours, theirs;  // words with blanks between them
};
constexpr OtherWords kOtherWords[] = {
    {"position", "pos place location translation"},
    {"rotation", "rot angle angles"},
    {"target", "lookat look_at aim"},
    {"fov", "zoom"},
    {"motion", "dynamic kinematic"},
    {"kind", "type"},
    {"mesh", "model file obj"},
    {"repeat", "count copies"},
    {"density", "weight rho"},
    {"restitution", "bounce bounciness elasticity"},
    {"young", "stiffness youngs_modulus"},
    {"strength", "tensile_strength"},
    {"fracture_energy", "toughness"},
    {"seconds", "duration length time"},
    {"at", "time start"},
    {"after", "delay"},
    {"ground", "floor"},
    {"backdrop", "background"},
    {"projectile", "throw shoot fire launch"},
    {"drop", "spawn"},
    {"push", "kick"},
    {"explosion", "explode blast bomb"},
    {"speed", "slow slowmo slow_motion"},
    {"caption", "text"},
    {"concrete", "stone rock cement"},
    {"ceramic", "tile tiles"},
    {"steel", "metal iron"},
    {"porcelain", "china"},
    {"terracotta", "clay"},
    {"plaster", "gypsum"},
    {"plane", "floor ground"},
    {"box", "cube"},
    {"sphere", "ball"},
    {"capsule", "cylinder rod"},
    {"pane", "window sheet"},
    {"wine_glass", "goblet flute"},
    {"ornament", "bauble"},
    {"point", "hinge chain rope"},
    {"mortar", "glue"},
    {"-o", "--out --output"},
    {"--size", "--resolution"},
    {"--seconds", "--duration"},
    {"--threads", "--jobs -j"},
};

bool has_word(std::string_view words, std::string_view word) {
  for (std::size_t begin = 0; begin < words.size();) {
    const std::size_t end = std::min(words.find(' ', begin), words.size());
    if (words.substr(begin, end - begin) == word) return true;
    begin = end + 1;
  }
  return false;
}

}  // namespace

int edit_distance(std::string_view a, std::string_view b) {
  const std::size_t width = b.size() + 1;
  std::vector<int> before_last(width), last(width), row(width);
  for (std::size_t j = 0; j < width; ++j) last[j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = static_cast<int>(i);
    for (std::size_t j = 1; j < width; ++j) {
      const int replace = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({replace, last[j] + 1, row[j - 1] + 1});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) row[j] = std::min(row[j], before_last[j - 2] + 1);
    }
    before_last.swap(last);
    last.swap(row);
  }
  return last[b.size()];
}

std::string nearest_name(std::string_view name, const std::vector<std::string>& known) {
  std::string nearest;
  int least = 0;
  const std::string lower = lower_case(name);
  for (const auto& [ours, theirs] : kOtherWords)
    if (has_word(theirs, lower) && std::find(known.begin(), known.end(), ours) != known.end())
      return std::string(ours);
  for (const std::string& candidate : known) {
    const int distance = edit_distance(lower, lower_case(candidate));
    const int allowed = std::max(2, static_cast<int>(std::max(name.size(), candidate.size())) / 3);
    const bool all_wrong = distance >= static_cast<int>(std::max(name.size(), candidate.size()));
    if (distance > allowed || all_wrong) continue;
    if (nearest.empty() || distance < least) {
      nearest = candidate;
      least = distance;
    }
  }
  return nearest;
}

std::string quoted_list(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "\"" : ", \"") + name + "\"";
  return text;
}

std::string hint_for_name(std::string_view name, const std::vector<std::string>& known,
                          std::string_view what) {
  const std::string nearest = nearest_name(name, known);
  std::string hint;
  if (!nearest.empty()) hint = "did you mean \"" + nearest + "\"? ";
  if (known.empty()) return hint + "there is no " + std::string(what) + " here";
  return hint + std::string(what) + ": " + quoted_list(known);
}

}  // namespace shatterbox::sandbox::scene
