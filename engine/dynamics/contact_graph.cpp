#include "engine/dynamics/contact_graph.h"

#include <algorithm>

#include "engine/core/disjoint_sets.h"
#include "engine/core/index.h"
#include "engine/core/parallel.h"
#include "engine/dynamics/contact_place.h"

namespace shatterbox::dynamics {
namespace {

using collision::Contact;
using core::at;

}  // namespace

SolverContact make_solver_contact(const PairState& memory, const MotionWork& work, int pair_number,
                                  const Contact& found) {
  const WorkPair& pair = work.pairs[at(pair_number)];
  const WorkBody &a = work.bodies[at(pair.a)], &b = work.bodies[at(pair.b)];
  SolverContact c;
  c.a = pair.a;
  c.b = pair.b;
  c.pair = pair_number;
  c.found = found;
  c.friction = pair.material.friction;
  c.restitution = pair.material.restitution;
  c.rolling = pair.material.rolling_friction;
  c.kept_gap = pair.kept_gap;
  c.threshold = pair.threshold;
  int axis = 0;
  found.normal.cwiseAbs().minCoeff(&axis);
  c.tangent_start = found.normal.cross(Vec3::Unit(axis)).normalized();
  reset_axes(c);
  c.arm_a_start = found.on_a - a.start.translation;
  c.arm_b_start = found.on_b - b.start.translation;
  c.has_sides = pair.has_sides;
  c.is_close = pair.is_close;
  c.can_creep = a.is_quiet && b.is_quiet && !body::is_round(a.shape->kind) && !body::is_round(b.shape->kind);
  const auto known =
      std::lower_bound(memory.contacts.begin(), memory.contacts.end(), found.key,
                       [](const RememberedContact& r, std::uint64_t key) { return r.feature_key < key; });
  if (known != memory.contacts.end() && known->feature_key == found.key) {
    c.was_loaded = known->was_loaded;
    c.arrival_before = known->arrival_speed;
    c.hit_left_before = known->hit_left;
    c.creep_before = known->creep;
    c.warm_start = {known->normal_impulse, c.tangent_u.dot(known->friction_impulse),
                    c.tangent_v.dot(known->friction_impulse)};
    c.warm_start *= work.warm_scale;
  }
  return c;
}

void build_contact_graph(const ContactState& state, MotionWork& work) {
  std::vector<std::size_t> begin(work.pairs.size() + 1, 0);
  for (std::size_t p = 0; p < work.pairs.size(); ++p) {
    const WorkPair& pair = work.pairs[p];
    const bool is_held =
        work.bodies[at(pair.a)].inverse_mass == 0.0 && work.bodies[at(pair.b)].inverse_mass == 0.0;
    begin[p + 1] = begin[p] + (is_held ? 0 : pair.contacts.size());
  }
  work.contacts.resize(begin.back());
  core::parallel_for(work.pairs.size(), 64, [&](std::size_t p) {
    const WorkPair& pair = work.pairs[p];
    for (std::size_t k = begin[p]; k < begin[p + 1]; ++k)
      work.contacts[k] = make_solver_contact(state.pairs[at(pair.state)], work, static_cast<int>(p),
                                             pair.contacts[k - begin[p]]);
  });
  build_islands(work);
}

void build_islands(MotionWork& work) {
  work.islands.clear();
  core::DisjointSets joined(work.bodies.size());
  for (const SolverContact& c : work.contacts) {
    WorkBody &a = work.bodies[at(c.a)], &b = work.bodies[at(c.b)];
    if (a.inverse_mass > 0.0) a.is_free = false;
    if (b.inverse_mass > 0.0) b.is_free = false;
    if (a.is_free || b.is_free) continue;
    joined.unite(c.a, c.b);
  }
  for (const WorkJoint& joint : work.joints) {
    WorkBody &a = work.bodies[at(joint.a)], &b = work.bodies[at(joint.b)];
    if (a.inverse_mass > 0.0) a.is_free = false;
    if (b.inverse_mass > 0.0) b.is_free = false;
    if (!a.is_free && !b.is_free) joined.unite(joint.a, joint.b);
  }
  std::vector<int> number(work.bodies.size(), -1);
  for (std::size_t i = 0; i < work.bodies.size(); ++i) {
    if (work.bodies[i].is_free) continue;
    int& island = number[at(joined.find(static_cast<int>(i)))];
    if (island < 0) {
      island = static_cast<int>(work.islands.size());
      work.islands.emplace_back();
    }
    work.islands[at(island)].bodies.push_back(static_cast<int>(i));
  }
  const auto island_of = [&](int a, int b) -> Island& {
    const int member = work.bodies[at(a)].is_free ? b : a;
    return work.islands[at(number[at(joined.find(member))])];
  };
  for (std::size_t i = 0; i < work.contacts.size(); ++i) {
    const SolverContact& c = work.contacts[i];
    Island& island = island_of(c.a, c.b);
    island.contacts.push_back(static_cast<int>(i));
    if (work.bodies[at(c.a)].may_break || work.bodies[at(c.b)].may_break) island.may_break = true;
  }
  for (std::size_t i = 0; i < work.joints.size(); ++i) {
    Island& island = island_of(work.joints[i].a, work.joints[i].b);
    island.joints.push_back(static_cast<int>(i));
    island.may_break = true;
  }
}

}  // namespace shatterbox::dynamics
