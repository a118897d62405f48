#include "engine/dynamics/contact_order.h"

#include <algorithm>
#include <span>

#include "engine/core/index.h"

namespace shatterbox::dynamics {
namespace {

using core::at;

constexpr std::size_t kPart = 64;   // contacts of a smallest part, about
constexpr std::size_t kSlice = 24;  // contacts, or more if a pair has them

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

// Bodies in halves of halves, each along the direction in which it is longest, with as many contacts in one
// as in the other.
class Parts {
 public:
  Parts(const Island& island, const MotionWork& work)
      : work_(work), part_of_(work.bodies.size(), 0), weights_(work.bodies.size(), 0) {
    for (const int i : island.contacts)
      for (const int body : {work.contacts[at(i)].a, work.contacts[at(i)].b}) ++weights_[at(body)];
    while (island.contacts.size() >> (levels_ + 1) >= kPart) ++levels_;
    bodies_ = island.bodies;
    part(bodies_, 1, 0);
  }

  std::size_t levels() const { return levels_; }
  const std::vector<int>& bodies() const { return bodies_; }

  // The smallest part in which both are that impulses move.
  std::size_t common(const SolverContact& c) const {
    std::size_t a = part_of_[at(moves(c.a) ? c.a : c.b)], b = part_of_[at(moves(c.b) ? c.b : c.a)];
    for (; a != b; a /= 2) b /= 2;
    return a;
  }

 private:
  bool moves(int body) const { return work_.bodies[at(body)].inverse_mass > 0.0; }
  const Vec3& place(int body) const { return work_.bodies[at(body)].start.translation; }

  void part(std::span<int> bodies, std::size_t number, std::size_t level) {
    if (level == levels_) {
      for (const int i : bodies) part_of_[at(i)] = number;
      return;
    }
    geometry::Box box;
    std::size_t weight = 0, half = 0, middle = 0;
    for (const int i : bodies) {
      box.include(place(i));
      weight += weights_[at(i)];
    }
    int axis = 0;
    if (!bodies.empty()) (box.high - box.low).maxCoeff(&axis);
    std::stable_sort(bodies.begin(), bodies.end(),
                     [&](int x, int y) { return place(x)[axis] < place(y)[axis]; });
    while (middle < bodies.size() && 2 * half < weight) half += weights_[at(bodies[middle++])];
    part(bodies.first(middle), 2 * number, level + 1);
    part(bodies.subspan(middle), 2 * number + 1, level + 1);
  }

  const MotionWork& work_;
  std::size_t levels_ = 0;
  std::vector<std::size_t> part_of_, weights_;  // per body
  std::vector<int> bodies_;
};

}  // namespace

ContactOrder order_contacts(const Island& island, const MotionWork& work) {
  ContactOrder order;
  if (!island.is_large()) {
    order.contacts = island.contacts;
    order.parts = {{}, {0, island.contacts.size()}};
    return order;
  }
  // What was found on the way lies behind all others.
  std::vector<int> contacts = island.contacts;
  std::stable_sort(contacts.begin(), contacts.end(),
                   [&](int x, int y) { return work.contacts[at(x)].pair < work.contacts[at(y)].pair; });
  const Parts parts(island, work);
  order.bodies = parts.bodies();
  std::vector<std::vector<ContactOrder::Range>> pairs_in(std::size_t{2} << parts.levels());
  for (const ContactOrder::Range& pair : find_pairs(contacts, work))
    pairs_in[parts.common(work.contacts[at(contacts[pair.begin])])].push_back(pair);
  order.contacts.reserve(contacts.size());
  order.parts.resize(pairs_in.size());
  for (std::size_t first = order.count_smallest(); first > 0; first /= 2) {
    for (std::size_t number = first; number < 2 * first; ++number) {
      ContactOrder::Range& part = order.parts[number];
      part = {order.contacts.size(), order.contacts.size()};
      ContactOrder::Range slice = part;
      for (const ContactOrder::Range& pair : pairs_in[number]) {
        for (std::size_t i = pair.begin; i < pair.end; ++i) order.contacts.push_back(contacts[i]);
        slice.end = part.end = order.contacts.size();
        if (slice.end - slice.begin < kSlice) continue;
        order.slices.push_back(slice);
        slice.begin = slice.end;
      }
      if (slice.begin < slice.end) order.slices.push_back(slice);
    }
  }
  return order;
}

}  // namespace shatterbox::dynamics
