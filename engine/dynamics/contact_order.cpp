#include "engine/dynamics/contact_order.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <numeric>

#include "engine/core/index.h"

namespace shatterbox::dynamics {
namespace {

using core::at;

constexpr std::size_t kColours = 64;
constexpr std::size_t kChunk = 24;  // contacts, or more if a pair has them

// Ranges of contacts, ordered by their pairs.
std::vector<ContactOrder::Range> find_pairs(const std::vector<int>& contacts, const MotionWork& work) {
  std::vector<ContactOrder::Range> pairs;
  int last = -1;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const int pair = work.contacts[at(contacts[i])].pair;
    if (pair != last) pairs.push_back({i, i});
    last = pair;
    pairs.back().end = i + 1;
  }
  return pairs;
}

class Palette {
 public:
  explicit Palette(const MotionWork& work) : work_(work), taken_(work.bodies.size(), 0) {}

  // kColours: none is left.
  std::size_t take(int a, int b) {
    const bool a_moves = moves(a), b_moves = moves(b);
    const std::uint64_t taken = (a_moves ? taken_[at(a)] : 0) | (b_moves ? taken_[at(b)] : 0);
    const auto colour = static_cast<std::size_t>(std::countr_one(taken));
    if (colour == kColours) return colour;
    const std::uint64_t bit = std::uint64_t{1} << colour;
    if (a_moves) taken_[at(a)] |= bit;
    if (b_moves) taken_[at(b)] |= bit;
    return colour;
  }

 private:
  bool moves(int body) const { return work_.bodies[at(body)].inverse_mass > 0.0; }

  const MotionWork& work_;
  std::vector<std::uint64_t> taken_;  // per body, a bit a colour
};

// Where bodies, and what lies between two, are along the direction in which an island is longest.
class Along {
 public:
  Along(const Island& island, const MotionWork& work) : work_(work) {
    geometry::Box box;
    for (const int i : island.bodies) box.include(work.bodies[at(i)].start.translation);
    if (!island.bodies.empty()) (box.high - box.low).maxCoeff(&axis_);
  }

  double of(int body) const { return work_.bodies[at(body)].start.translation[axis_]; }
  // What holds still may be anywhere.
  double of(const SolverContact& c) const {
    const bool a_moves = work_.bodies[at(c.a)].inverse_mass > 0.0,
               b_moves = work_.bodies[at(c.b)].inverse_mass > 0.0;
    return a_moves && b_moves ? 0.5 * (of(c.a) + of(c.b)) : of(a_moves ? c.a : c.b);
  }

 private:
  const MotionWork& work_;
  int axis_ = 0;
};

template <class Item, class Key>
void sort_along(std::vector<Item>& items, const Key& key) {
  std::stable_sort(items.begin(), items.end(), [&](const Item& x, const Item& y) { return key(x) < key(y); });
}

}  // namespace

ContactOrder order_contacts(const Island& island, const MotionWork& work) {
  ContactOrder order;
  const std::size_t count = island.contacts.size();
  if (!island.is_large()) {
    order.contacts = island.contacts;
    order.chunks = {{0, count}};
    order.rounds = {{0, 1}};
    return order;
  }
  // What was found on the way lies behind all others.
  std::vector<int> contacts = island.contacts;
  std::stable_sort(contacts.begin(), contacts.end(),
                   [&](int x, int y) { return work.contacts[at(x)].pair < work.contacts[at(y)].pair; });
  Palette palette(work);
  std::array<std::vector<ContactOrder::Range>, kColours + 1> by_colour;
  for (const ContactOrder::Range& pair : find_pairs(contacts, work)) {
    const SolverContact& c = work.contacts[at(contacts[pair.begin])];
    by_colour[palette.take(c.a, c.b)].push_back(pair);
  }
  const Along along(island, work);
  order.contacts.reserve(count);
  for (std::size_t colour = 0; colour <= kColours; ++colour) {
    if (by_colour[colour].empty()) continue;
    if (colour < kColours) {
      sort_along(by_colour[colour], [&](const ContactOrder::Range& pair) {
        return along.of(work.contacts[at(contacts[pair.begin])]);
      });
    }
    const std::size_t first = order.chunks.size();
    order.chunks.push_back({order.contacts.size(), order.contacts.size()});
    for (const ContactOrder::Range& pair : by_colour[colour]) {
      // Who found no colour is in one chunk with all others of that kind.
      if (colour < kColours && order.contacts.size() - order.chunks.back().begin >= kChunk)
        order.chunks.push_back({order.contacts.size(), order.contacts.size()});
      for (std::size_t i = pair.begin; i < pair.end; ++i) order.contacts.push_back(contacts[i]);
      order.chunks.back().end = order.contacts.size();
    }
    order.rounds.push_back({first, order.chunks.size()});
  }
  order.chunks_along.resize(order.chunks.size());
  std::iota(order.chunks_along.begin(), order.chunks_along.end(), std::size_t{0});
  sort_along(order.chunks_along, [&](std::size_t chunk) {
    return along.of(work.contacts[at(order.contacts[order.chunks[chunk].begin])]);
  });
  order.bodies_along = island.bodies;
  sort_along(order.bodies_along, [&](int body) { return along.of(body); });
  return order;
}

}  // namespace shatterbox::dynamics
