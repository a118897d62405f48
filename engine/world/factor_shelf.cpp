#include "engine/world/factor_shelf.h"

#include <algorithm>
#include <vector>

namespace shatterbox::world {
namespace {

/// Share of the bytes that is left: who clears out seldom gives up more than is needed.
constexpr double kKept = 0.8;

struct Kept {
  long used = 0;
  body::BodyId id = 0;
  double bytes = 0.0;
  stress::ShellSystemCache* systems = nullptr;
};

}  // namespace

void FactorShelf::clear_out(const Fragiles& fragiles, const std::map<body::BodyId, Ancestry>& ancestry) {
  ++turn_;
  std::erase_if(used_, [&](const auto& use) { return !fragiles.contains(use.first); });
  std::vector<Kept> kept;
  double sum = 0.0;
  for (const auto& [id, turn] : used_) {
    const auto* subject = std::get_if<fracture::ShellSubject>(&fragiles.at(id)->subject);
    if (!subject || ancestry.at(id).parent == 0) continue;
    stress::ShellSystemCache* systems = subject->systems.get();
    kept.push_back({turn, id, systems->bytes(), systems});
    sum += kept.back().bytes;
  }
  if (sum <= most_bytes_) return;
  std::sort(kept.begin(), kept.end(),
            [](const Kept& x, const Kept& y) { return x.used != y.used ? x.used < y.used : x.id < y.id; });
  for (const Kept& k : kept) {
    if (sum <= kKept * most_bytes_) break;
    k.systems->give_up();
    used_.erase(k.id);
    sum -= k.bytes;
  }
}

}  // namespace shatterbox::world
