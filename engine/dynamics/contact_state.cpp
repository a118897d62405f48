#include "engine/dynamics/contact_state.h"

#include <algorithm>
#include <cmath>

#include "engine/core/parallel.h"
#include "engine/dynamics/contact_settings.h"

namespace shatterbox::dynamics {
namespace {

template <class Pairs>
auto* find_in(Pairs& pairs, body::BodyId a, body::BodyId b) {
  if (a > b) std::swap(a, b);
  const auto place = std::lower_bound(
      pairs.begin(), pairs.end(), std::pair(a, b),
      [](const PairState& p, const auto& key) { return std::pair(p.body_a, p.body_b) < key; });
  return place != pairs.end() && place->body_a == a && place->body_b == b ? &*place : nullptr;
}

std::uint64_t hash_of(const PairState& pair) {
  core::Hash hash;
  hash.add((static_cast<std::uint64_t>(pair.body_a) << 32) | pair.body_b);
  hash.add(pair.kept_gap).add(static_cast<std::uint64_t>(pair.is_touching));
  hash.add(static_cast<std::uint64_t>(pair.has_parted));
  hash.add(static_cast<std::uint64_t>(pair.trouble_age)).add(static_cast<std::uint64_t>(pair.stuck_steps));
  hash.add(static_cast<std::uint64_t>(pair.is_exempt));
  if (pair.is_hooked) hash.add(std::uint64_t{1});
  for (const RememberedContact& c : pair.contacts) {
    hash.add(c.feature_key).add(c.normal_impulse).add(c.friction_impulse).add(c.creep).add(c.arrival_speed);
    hash.add(static_cast<std::uint64_t>(c.was_loaded));
    if (c.hit_left > 0.0) hash.add(c.hit_left);
  }
  return hash.value();
}

}  // namespace

PairState* ContactState::find_pair(body::BodyId a, body::BodyId b) {
  return find_in(pairs, a, b);
}
const PairState* ContactState::find_pair(body::BodyId a, body::BodyId b) const {
  return find_in(pairs, a, b);
}

void know_shape(BodyState& body) {
  body.collider = collision::make_collider(*body.shape);
  body.inertia = find_principal_inertia(body.shape->inertia);
}

void add_to_hash(const ContactState& state, core::Hash& hash) {
  hash.add(state.substep).add(static_cast<std::uint64_t>(state.next_parts));
  for (const BodyState& body : state.bodies) {
    hash.add(static_cast<std::uint64_t>(body.id))
        .add(body.rest_pose.translation)
        .add(body.rest_pose.rotation);
  }
  add_to_hash(state.joints, hash);
  if (state.swing > 0.0) hash.add(state.swing);
  // Pairs at once: in one chain each number would wait for the one before.
  std::vector<std::uint64_t> of_pairs(state.pairs.size());
  core::parallel_for(of_pairs.size(), 256, [&](std::size_t p) { of_pairs[p] = hash_of(state.pairs[p]); });
  for (const std::uint64_t of_pair : of_pairs) hash.add(of_pair);
}

PairMaterial pair_material(const body::Body& a, const body::Body& b, const ContactSettings& settings) {
  PairMaterial result;
  result.rolling_friction = std::max(a.rolling_friction, b.rolling_friction);
  for (const PairOverride& o : settings.overrides) {
    if ((o.material_a == a.material && o.material_b == b.material) ||
        (o.material_a == b.material && o.material_b == a.material)) {
      result.friction = o.friction;
      result.restitution = o.restitution;
      return result;
    }
  }
  result.friction = std::sqrt(std::max(0.0, a.friction * b.friction));
  result.restitution = std::min(a.restitution, b.restitution);
  return result;
}

}  // namespace shatterbox::dynamics
