#include "engine/collision/contact.h"

#include <algorithm>

namespace shatterbox::collision {

void reduce_manifold(std::vector<Contact>& contacts, const std::vector<std::uint64_t>& loaded_keys,
                     double loaded_reach, double radius, std::size_t cap) {
  constexpr double kSameWay = 0.97;
  struct Ranked {
    double rank;
    std::uint64_t key;
    std::size_t place;
  };
  std::vector<Ranked> order;
  order.reserve(contacts.size());
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Contact& c = contacts[i];
    const bool is_loaded = std::binary_search(loaded_keys.begin(), loaded_keys.end(), c.key);
    order.push_back({is_loaded && c.gap < loaded_reach ? c.gap - loaded_reach : c.gap, c.key, i});
  }
  std::sort(order.begin(), order.end(), [](const Ranked& x, const Ranked& y) {
    return x.rank < y.rank || (x.rank == y.rank && x.key < y.key);
  });
  std::vector<Contact> kept;
  for (const Ranked& ranked : order) {
    if (kept.size() >= cap) break;
    const Contact& c = contacts[ranked.place];
    const bool is_doubled = std::any_of(kept.begin(), kept.end(), [&](const Contact& k) {
      return k.key == c.key ||
             (k.normal.dot(c.normal) > kSameWay && (k.on_a - c.on_a).squaredNorm() < radius * radius);
    });
    if (!is_doubled) kept.push_back(c);
  }
  std::sort(kept.begin(), kept.end(), [](const Contact& x, const Contact& y) { return x.key < y.key; });
  contacts = std::move(kept);
}

}  // namespace shatterbox::collision
