#include "engine/world/clashes.h"

#include <algorithm>
#include <memory>

#include "engine/collision/broad_phase.h"
#include "engine/collision/feature_gap.h"
#include "engine/collision/feature_list.h"
#include "engine/core/index.h"
#include "engine/core/parallel.h"
#include "engine/dynamics/motion_work.h"

namespace shatterbox::world {
namespace {

using body::Body;
using collision::IndexPair;
using core::at;
using Size = std::size_t;

struct Placed {
  std::shared_ptr<const collision::Collider> collider;
  collision::PlacedCollider placed;
  geometry::Box box;
};

Placed place(const Body& body, std::shared_ptr<const collision::Collider> collider) {
  Placed out;
  out.collider = std::move(collider);
  out.placed = collision::place_collider(*out.collider, body.pose);
  for (const Vec3& v : out.placed.start) out.box.include(v);
  return out;
}

/// Null: nobody has met a body of that shape yet.
std::shared_ptr<const collision::Collider> known_collider(const Body& body,
                                                          const dynamics::ContactState& contact) {
  const auto known = std::lower_bound(contact.bodies.begin(), contact.bodies.end(), body.id,
                                      [](const auto& state, body::BodyId id) { return state.id < id; });
  if (known != contact.bodies.end() && known->id == body.id && known->shape == body.shape)
    return known->collider;
  for (const dynamics::BodyState& state : contact.shelf->newborn)
    if (state.shape == body.shape) return state.collider;
  return nullptr;
}

/// Of all these; those that had to be made are on the shelf from now on.
std::vector<Placed> place_all(const std::vector<const Body*>& all, const dynamics::ContactState& contact) {
  std::vector<std::shared_ptr<const collision::Collider>> colliders;
  std::vector<Size> unknown;
  for (const Body* body : all) {
    colliders.push_back(known_collider(*body, contact));
    if (!colliders.back()) unknown.push_back(colliders.size() - 1);
  }
  std::vector<dynamics::BodyState> made(unknown.size());
  core::parallel_for(made.size(), 1, [&](Size k) {
    made[k].shape = all[unknown[k]]->shape;
    dynamics::know_shape(made[k]);
    colliders[unknown[k]] = made[k].collider;
  });
  std::vector<dynamics::BodyState>& newborn = contact.shelf->newborn;
  newborn.insert(newborn.end(), made.begin(), made.end());
  std::vector<Placed> placed(all.size());
  core::parallel_for(placed.size(), 1, [&](Size i) { placed[i] = place(*all[i], std::move(colliders[i])); });
  return placed;
}

/// Those with a surface that a piece of the whole may stick out into.
std::vector<const Body*> find_neighbours(const Body& whole, const std::vector<Body>& bodies) {
  std::vector<const Body*> out;
  for (const Body& other : bodies) {
    if (other.id == whole.id || !body::is_mesh(other.shape->kind)) continue;
    const double reach = whole.shape->bounding_radius + other.shape->bounding_radius;
    if ((other.pose.translation - whole.pose.translation).norm() <= reach) out.push_back(&other);
  }
  return out;
}

/// Whether two pieces still coincide in places: where neither could draw back from the crack between them
/// (their kerf is zero there), no direction separates them, and contact could not tell them apart.
bool touch(const Placed& a, const Placed& b) {
  const double size = 2.0 * std::min(a.collider->bounding_radius, b.collider->bounding_radius);
  return collision::are_within(a.placed, b.placed, dynamics::kNoDistance * size);
}

enum class Meeting { none, touch, cross };

Meeting find_meeting(const Placed& a, const Placed& b) {
  if (collision::crosses(a.placed, b.placed)) return Meeting::cross;
  return touch(a, b) ? Meeting::touch : Meeting::none;
}

}  // namespace

std::vector<fracture::PieceClash> find_clashes(const Body& whole, const std::vector<Body>& born,
                                               const std::vector<Body>& bodies,
                                               const dynamics::ContactState& contact) {
  std::vector<const Body*> all;
  for (const Body& piece : born) all.push_back(&piece);
  for (const Body* neighbour : find_neighbours(whole, bodies)) all.push_back(neighbour);
  const std::vector<Placed> placed = place_all(all, contact);
  std::vector<collision::SweptBound> bounds;
  for (Size i = 0; i < placed.size(); ++i) bounds.push_back({placed[i].box, i < born.size()});
  const std::vector<IndexPair> pairs = collision::find_overlapping_pairs(bounds);
  std::vector<Meeting> meetings(pairs.size());
  core::parallel_for(pairs.size(), 1, [&](Size k) {
    meetings[k] = find_meeting(placed[at(pairs[k].a)], placed[at(pairs[k].b)]);
  });

  std::vector<fracture::PieceClash> clashes;
  std::vector<Placed> before;  // where the whole is
  for (Size k = 0; k < pairs.size(); ++k) {
    if (meetings[k] == Meeting::none) continue;
    const auto [a, b] = pairs[k];
    if (at(b) < born.size()) {
      clashes.push_back({a, b});
      continue;
    }
    if (before.empty()) before = place_all({&whole}, contact);
    if (find_meeting(before[0], placed[at(b)]) < meetings[k]) clashes.push_back({a, -1});
  }
  return clashes;
}

}  // namespace shatterbox::world
