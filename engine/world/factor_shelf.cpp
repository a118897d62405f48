#include "engine/world/factor_shelf.h"

#include <algorithm>
#include <vector>

namespace shatterbox::world {
namespace {

/// Share of the bytes that is left: who clears out seldom gives up more than is needed.
constexpr double kKept = 0.8;

/// Of a piece of a shell; null of others.
stress::ShellSystemCache* find_systems(const Fragile& fragile, const Ancestry& from) {
  const auto* subject = std::get_if<fracture::ShellSubject>(&fragile.subject);
  return subject && from.parent != 0 ? subject->systems.get() : nullptr;
}

}  // namespace

void FactorShelf::clear_out(const Fragiles& fragiles, const std::map<body::BodyId, Ancestry>& ancestry) {
  std::erase_if(used_, [&](const auto& use) { return !fragiles.contains(use.first); });
  double sum = 0.0;
  for (auto& [id, use] : used_) {
    if (use.turn == turn_) {
      const auto* systems = find_systems(*fragiles.at(id), ancestry.at(id));
      use.bytes = systems ? systems->bytes() : 0.0;
    }
    sum += use.bytes;
  }
  ++turn_;
  if (sum > most_bytes_) give_up_oldest(sum, fragiles, ancestry);
}

void FactorShelf::give_up_oldest(double sum, const Fragiles& fragiles,
                                 const std::map<body::BodyId, Ancestry>& ancestry) {
  std::vector<std::pair<long, body::BodyId>> kept;  // of those that have any; the last turn comes first
  for (const auto& [id, use] : used_)
    if (use.bytes > 0.0) kept.emplace_back(use.turn, id);
  std::sort(kept.begin(), kept.end());
  for (const auto& [turn, id] : kept) {
    if (sum <= kKept * most_bytes_) break;
    // An id may be another's since a step was put back.
    if (auto* systems = find_systems(*fragiles.at(id), ancestry.at(id))) systems->give_up();
    sum -= used_.at(id).bytes;
    used_.erase(id);
  }
}

}  // namespace shatterbox::world
