#include "engine/world/factor_shelf.h"

#include <algorithm>
#include <vector>

#include "engine/world/forms.h"

namespace shatterbox::world {
namespace {

struct Kept {
  long used = 0;
  body::BodyId id = 0;
  double bytes = 0.0;
};

std::shared_ptr<const Fragile> without_factors(const Fragile& fragile) {
  auto bare = std::make_shared<Fragile>(fragile);
  auto& subject = std::get<fracture::ShellSubject>(bare->subject);
  subject.systems = make_systems(subject, subject.systems->shared_stiffness());
  return bare;
}

}  // namespace

void FactorShelf::clear_out(Fragiles& fragiles, const std::map<body::BodyId, Ancestry>& ancestry) {
  std::erase_if(used_, [&](const auto& use) { return !fragiles.contains(use.first); });
  std::vector<Kept> kept;
  double sum = 0.0;
  for (const auto& [id, step] : used_) {
    const auto* subject = std::get_if<fracture::ShellSubject>(&fragiles.at(id)->subject);
    if (!subject || ancestry.at(id).parent == 0) continue;
    kept.push_back({step, id, sizeof(double) * subject->systems->factor_entries()});
    sum += kept.back().bytes;
  }
  if (sum <= most_bytes_) return;
  std::sort(kept.begin(), kept.end(),
            [](const Kept& x, const Kept& y) { return x.used != y.used ? x.used < y.used : x.id < y.id; });
  for (const Kept& k : kept) {
    if (sum <= 0.5 * most_bytes_) break;
    fragiles[k.id] = without_factors(*fragiles.at(k.id));
    used_.erase(k.id);
    sum -= k.bytes;
  }
}

}  // namespace shatterbox::world
