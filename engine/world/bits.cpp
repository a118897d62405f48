#include "engine/world/bits.h"

namespace shatterbox::world {

namespace {

std::uint64_t as_word(long number) {
  return static_cast<std::uint64_t>(number);
}

void add_to_hash(const ImpactMemory& memory, core::Hash& hash) {
  hash.add(memory.event_duration).add(memory.tested_contact).add(memory.tested_growth);
  hash.add(memory.solved_contact).add(memory.solved_ratio);
  hash.add(as_word(memory.generation));
  for (const Load& load : memory.event) hash.add(load.impulse_body).add(load.point_body).add(load.time);
  for (const Load& load : memory.contact) hash.add(load.impulse_body).add(load.time);
  for (const ComingDent& coming : memory.dents) hash.add(coming.figures().work);
  if (memory.charged_event != 0) hash.add(memory.charged_until).add(memory.charged_left);
}

void add_to_hash(const JointMemories& memories, core::Hash& hash) {
  for (const auto& [number, memory] : memories) {
    hash.add(as_word(number)).add(memory.event_duration).add(memory.event_time);
    hash.add(memory.event_impulse).add(memory.event_couple);
    for (const JointMemory::Load& load : memory.contact)
      hash.add(load.time).add(load.impulse).add(load.couple);
  }
}

void add_contacts(const MovingState& moving, core::Hash& hash) {
  add_to_hash(moving.joint_memories, hash);
  dynamics::add_to_hash(moving.contact, hash);
  dynamics::add_to_hash(moving.paper_contact, hash);
}

void add_path(const body::Body& body, core::Hash& hash) {
  if (body.script.path) hash.add(body.script.time).add(body.script.pace).add(body.script.wait);
}

template <class... Values>
std::uint64_t hash_of(const Values&... values) {
  core::Hash hash;
  (hash.add(values), ...);
  return hash.value();
}

}  // namespace

std::uint64_t hash_state(const MovingState& moving, long steps, std::uint64_t previous) {
  core::Hash hash(previous);
  hash.add(as_word(steps));
  for (const body::Body& body : moving.bodies) {
    hash.add(std::uint64_t{body.id}).add(body.pose.rotation).add(body.pose.translation);
    hash.add(body.velocity).add(body.angular_velocity).add(std::uint64_t{body.is_awake}).add(body.quiet_time);
    add_path(body, hash);
  }
  for (const auto& [id, memory] : moving.memories) {
    hash.add(std::uint64_t{id});
    add_to_hash(memory, hash);
  }
  add_contacts(moving, hash);
  return hash.value();
}

std::vector<BodyBits> hash_bodies(const MovingState& moving, const ElementStress& element_stress) {
  std::vector<BodyBits> bits;
  bits.reserve(moving.bodies.size());
  for (const body::Body& body : moving.bodies) {
    core::Hash path, loads, stress;
    add_path(body, path);
    if (const auto memory = moving.memories.find(body.id); memory != moving.memories.end())
      add_to_hash(memory->second, loads);
    if (const auto known = element_stress.find(body.id); known != element_stress.end())
      for (const double value : *known->second) stress.add(value);
    bits.push_back({body.id,
                    {hash_of(body.pose.translation), hash_of(body.pose.rotation), hash_of(body.velocity),
                     hash_of(body.angular_velocity), hash_of(std::uint64_t{body.is_awake}, body.quiet_time),
                     path.value(), loads.value(), stress.value()}});
  }
  return bits;
}

std::uint64_t hash_contacts(const MovingState& moving) {
  core::Hash hash;
  add_contacts(moving, hash);
  return hash.value();
}

}  // namespace shatterbox::world
