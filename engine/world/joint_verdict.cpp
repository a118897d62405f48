#include <algorithm>
#include <cmath>
#include <map>

#include "engine/core/disjoint_sets.h"
#include "engine/core/elementary.h"
#include "engine/core/index.h"
#include "engine/stress/contact_duration.h"
#include "engine/world/impact.h"
#include "engine/world/joints.h"

namespace shatterbox::world {
namespace {

using core::at;

int number_of(const std::vector<body::Body>& bodies, body::BodyId id) {
  const body::Body* body = body::find_body(bodies, id);
  return body != nullptr && body->is_dynamic() ? static_cast<int>(body - bodies.data()) : -1;
}

// Bodies that move together, by their numbers.
core::DisjointSets join_bodies(const std::vector<dynamics::Joint>& joints,
                               const std::vector<body::Body>& bodies) {
  core::DisjointSets joined(bodies.size());
  for (const dynamics::Joint& joint : joints) {
    const int a = number_of(bodies, joint.body_a), b = number_of(bodies, joint.body_b);
    if (a >= 0 && b >= 0) joined.unite(a, b);
  }
  return joined;
}

// Of the one of its two bodies that moves; -1: none does.
int number_of_mover(const std::vector<body::Body>& bodies, const dynamics::Joint& joint) {
  const int a = number_of(bodies, joint.body_a);
  return a >= 0 ? a : number_of(bodies, joint.body_b);
}

// The hardest collision that bodies which hold together had in a part of a step.
struct Hit {
  double impulse = 0.0;   // N s; 0: none
  double duration = 0.0;  // s
  double time = 0.0;      // s, of the last
  bool is_blast = false;  // one of them was a blast's, which does not arrive in the solver
};

double duration_of(const body::LoggedImpulse& hit, const std::vector<body::Body>& bodies,
                   const WorldSettings& settings, const dynamics::ContactSettings& contact) {
  if (hit.duration > 0.0) return hit.duration;
  if (settings.stress_window) return *settings.stress_window;
  const body::Body *a = body::find_body(bodies, hit.body_a), *b = body::find_body(bodies, hit.body_b);
  // A blunt contact is as large as the smaller body, and a plane has no size.
  const auto size_of = [](const body::Body& body) {
    return body.shape->kind == body::ShapeKind::plane ? 1e300 : body.shape->bounding_radius;
  };
  if (a == nullptr || (b != nullptr && size_of(*b) < size_of(*a))) std::swap(a, b);
  const body::Body& struck = *a;
  const body::Body* other = b;
  const double restitution =
      other != nullptr ? dynamics::pair_material(struck, *other, contact).restitution : struck.restitution;
  const double speed = hit.closing_speed;
  const double mass = hit.impulse_world.norm() / ((1.0 + restitution) * speed);
  const stress::HertzContact pair = find_hertz_contact(struck, other);
  const double compliance = stress::hertz_compliance(pair, stress::peak_force(pair, mass, speed));
  return stress::series_duration(mass, compliance, 0.0);
}

// For each body the hit of all that it is joined to.
class Hits {
 public:
  Hits(const std::vector<dynamics::Joint>& joints, const std::vector<body::Body>& bodies)
      : bodies_(bodies), joined_(join_bodies(joints, bodies)), hits_(bodies.size()) {}

  void add(const body::LoggedImpulse& entry, double duration, double time) {
    for (const body::BodyId id : {entry.body_a, entry.body_b}) {
      const int i = number_of(bodies_, id);
      if (i < 0) continue;
      Hit& hit = hits_[at(joined_.find(i))];
      hit.time = std::max(hit.time, time);
      hit.is_blast = hit.is_blast || entry.duration > 0.0;
      const double impulse = entry.impulse_world.norm();
      if (impulse <= hit.impulse) continue;
      hit.impulse = impulse;
      hit.duration = duration;
    }
  }

  const Hit& of(const dynamics::Joint& joint) {
    const int i = number_of_mover(bodies_, joint);
    return i >= 0 ? hits_[at(joined_.find(i))] : none_;
  }

 private:
  const std::vector<body::Body>& bodies_;
  core::DisjointSets joined_;
  std::vector<Hit> hits_;
  Hit none_;
};

// What the joint gave lately, as much of it as fits in the part: that goes on beside a collision.
JointMemory::Load go_on(const std::vector<JointMemory::Load>& known, const PartTime& part) {
  JointMemory::Load load{part.start, Vec3::Zero(), Vec3::Zero()};
  if (known.empty()) return load;
  const double share = part.length / (part.start - known.front().time);
  for (const JointMemory::Load& one : known) {
    load.impulse += share * one.impulse;
    load.couple += share * one.couple;
  }
  return load;
}

// Adds what the joint gave in this part to its memory, as a collision's or as contact's.
void remember(const dynamics::Joint& joint, const Hit& hit, const PartTime& part, JointMemory& memory) {
  const JointMemory::Load before = go_on(memory.contact, part);
  const double oldest = part.start + 0.5 * part.length - part.average;
  std::erase_if(memory.contact, [&](const JointMemory::Load& load) { return load.time < oldest; });
  JointMemory::Load load{part.start, joint.impulse, joint.couple};
  const bool is_hit = hit.impulse > 0.0;
  if (!is_hit && part.start - memory.event_time > 2.0 * memory.event_duration) {
    memory.event_impulse = memory.event_couple = Vec3::Zero();
    memory.event_duration = 0.0;
  }
  if (is_hit || memory.event_duration > 0.0) {
    if (is_hit) memory.event_time = hit.time;
    if (is_hit) memory.event_duration = std::max(memory.event_duration, hit.duration);
    const bool is_told = joint.is_struck && !hit.is_blast;
    const Vec3 impulse = is_told ? joint.blow_impulse : Vec3(load.impulse - before.impulse);
    const Vec3 couple = is_told ? joint.blow_couple : Vec3(load.couple - before.couple);
    memory.event_impulse += impulse;
    memory.event_couple += couple;
    load.impulse -= impulse;
    load.couple -= couple;
  }
  memory.contact.push_back(load);
}

}  // namespace

JointVerdict judge_joint(const dynamics::Joint& joint, const JointNature& nature, const Vec3& force,
                         const Vec3& moment) {
  JointVerdict verdict;
  verdict.number = joint.number;
  verdict.force = force;
  verdict.moment = moment;
  if (joint.is_pivot) {
    verdict.tension = force.norm() / joint.area;
    verdict.ratio = verdict.tension / nature.strength;
    return verdict;
  }
  // On a, along x: pressed where it is more than nothing.
  double least = 1e300, reach = 0.0;
  for (const Vec2& p : nature.outline) {
    const double bent = moment.y() * p.y() / joint.moments.y() - moment.z() * p.x() / joint.moments.z();
    least = std::min(least, force.x() / joint.area + bent);
    reach = std::max(reach, p.norm());
  }
  verdict.tension = -least;
  const double twist = std::abs(moment.x()) * reach / joint.moments.x();
  verdict.shear = force.tail<2>().norm() / joint.area + twist;
  const double pressed = std::max(0.0, force.x() / joint.area);
  const double by_shear = verdict.shear / (nature.shear_strength + nature.friction * pressed);
  const double by_tension = std::max(0.0, verdict.tension) / nature.strength;
  verdict.is_by_shear = by_shear > by_tension;
  verdict.ratio = std::max(by_shear, by_tension);
  return verdict;
}

std::vector<JointVerdict> judge_joints(const std::vector<dynamics::Joint>& joints,
                                       const std::vector<JointNature>& natures,
                                       const std::vector<body::Body>& bodies, const body::ImpulseLog& log,
                                       const WorldSettings& settings,
                                       const dynamics::ContactSettings& contact, const PartTime& part,
                                       JointMemories& memories) {
  Hits hits(joints, bodies);
  for (const body::LoggedImpulse& entry : log) {
    const bool is_hit = entry.kind == body::ImpulseKind::collision && entry.impulse_world.squaredNorm() > 0.0;
    if (is_hit && (entry.closing_speed > 0.0 || entry.duration > 0.0))
      hits.add(entry, duration_of(entry, bodies, settings, contact), part.step_start + entry.time);
  }
  std::vector<JointVerdict> verdicts;
  for (const dynamics::Joint& joint : joints) {
    const JointNature& nature = natures[at(joint.number - 1)];
    JointMemory& memory = memories[joint.number];
    remember(joint, hits.of(joint), part, memory);
    Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
    for (const JointMemory::Load& load : memory.contact) {
      force += load.impulse / part.average;
      moment += load.couple / part.average;
    }
    const bool is_struck = memory.event_duration > 0.0;
    if (is_struck) {
      const double share = stress::kPeakOverMeanHalfSine / memory.event_duration;
      force += share * memory.event_impulse;
      moment += share * memory.event_couple;
    }
    verdicts.push_back(judge_joint(joint, nature, force, moment));
    verdicts.back().is_struck = is_struck;
  }
  return verdicts;
}

std::vector<int> find_opening(std::span<const JointVerdict> verdicts, double least,
                              const std::vector<dynamics::Joint>& joints,
                              const std::vector<body::Body>& bodies) {
  core::DisjointSets chains = join_bodies(joints, bodies);
  std::vector<int> opening;
  std::map<int, const JointVerdict*> weakest;  // of a chain
  for (std::size_t k = 0; k < joints.size(); ++k) {
    const JointVerdict& verdict = verdicts[k];
    if (verdict.ratio < least) continue;
    if (!joints[k].is_pivot) {
      opening.push_back(verdict.number);
      continue;
    }
    const JointVerdict*& known = weakest[chains.find(number_of_mover(bodies, joints[k]))];
    if (known == nullptr || verdict.ratio > known->ratio) known = &verdict;
  }
  for (const auto& [chain, verdict] : weakest) opening.push_back(verdict->number);
  std::sort(opening.begin(), opening.end());
  return opening;
}

}  // namespace shatterbox::world
