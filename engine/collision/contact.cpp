#include "engine/collision/contact.h"

#include <algorithm>
#include <cmath>

namespace shatterbox::collision {

void set_crossing_edges(const Vec3& edge_a, const Vec3& edge_b, Contact& contact) {
  constexpr double kLeastSine = 0.03, kAcross = 0.9999;
  contact.edge_a = edge_a.normalized();
  contact.edge_b = edge_b.normalized();
  const Vec3 across = contact.edge_a.cross(contact.edge_b);
  const double sine = across.norm();
  if (sine > kLeastSine && std::abs(across.dot(contact.normal)) > kAcross * sine)
    contact.normal_of = NormalOf::edges;
}

Vec3 turned_normal(const Contact& contact, const Mat3& turn_a, const Mat3& turn_b) {
  switch (contact.normal_of) {
    case NormalOf::place:
    case NormalOf::ball:
      return contact.normal;
    case NormalOf::face_a:
      return turn_a * contact.normal;
    case NormalOf::face_b:
      return turn_b * contact.normal;
    case NormalOf::edges: {
      const Vec3 across = (turn_a * contact.edge_a).cross(turn_b * contact.edge_b);
      const double length = across.norm();
      if (length < 1e-9) return contact.normal;  // turned until they are parallel
      const bool is_flipped = contact.edge_a.cross(contact.edge_b).dot(contact.normal) < 0.0;
      return across / (is_flipped ? -length : length);
    }
  }
  return contact.normal;
}

KeptContacts::KeptContacts(double radius, std::size_t most) : radius_(radius), most_(most) {}

void KeptContacts::offer(const Contact& c) {
  constexpr double kSameWay = 0.97;
  const bool is_doubled = std::any_of(kept_.begin(), kept_.end(), [&](const Contact& k) {
    return k.key == c.key ||
           (k.normal.dot(c.normal) > kSameWay && (k.on_a - c.on_a).squaredNorm() < radius_ * radius_);
  });
  if (!is_doubled) kept_.push_back(c);
}

std::vector<Contact> KeptContacts::take() {
  std::sort(kept_.begin(), kept_.end(), [](const Contact& x, const Contact& y) { return x.key < y.key; });
  return std::move(kept_);
}

void reduce_manifold(std::vector<Contact>& contacts, const std::vector<std::uint64_t>& loaded_keys,
                     double loaded_reach, double radius, std::size_t cap) {
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
  KeptContacts kept(radius, cap);
  for (const Ranked& ranked : order) {
    if (kept.is_full()) break;
    kept.offer(contacts[ranked.place]);
  }
  contacts = kept.take();
}

}  // namespace shatterbox::collision
