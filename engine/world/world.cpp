#include "engine/world/world.h"

#include <algorithm>
#include <stdexcept>

#include "engine/material/tempering.h"
#include "engine/world/limits.h"
#include "engine/world/state.h"

namespace shatterbox::world {

namespace {

constexpr double kMostFriction = 1e3;

}  // namespace

World::World(const WorldSettings& settings) : state_(std::make_unique<State>()) {
  if (settings.steps_per_second < 1 || settings.substeps < 1 || !is_within(settings.gravity, kMostGravity))
    throw std::invalid_argument("a world needs a step a second, a substep and a gravity within 1e9 m/s2");
  if (settings.crack_generations < 1 || settings.piece_generations < 1 || settings.most_generations < 0)
    throw std::invalid_argument("a world needs a generation of cracks, and none fewer of breaking than 0");
  if ((settings.stress_window && !is_positive(*settings.stress_window)) ||
      !is_positive(settings.paper_duration))
    throw std::invalid_argument("a world's durations are above zero");
  state_->settings = settings;
  state_->contact_settings.time_step = 1.0 / settings.steps_per_second;
  state_->contact_settings.gravity = settings.gravity;
  state_->contact_settings.has_sleep = settings.has_sleep;
  state_->contact_settings.substeps = settings.substeps;
}

World::World(std::unique_ptr<State> state) : state_(std::move(state)) {}
World::~World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

World World::copy() const {
  auto state = std::make_unique<State>(*state_);
  state->wants_to_stop = {};
  state->watcher = {};
  state->moving.contact.shelf = std::make_shared<dynamics::SearchShelf>();  // they may step at one time
  return World(std::move(state));
}

core::Result<int> World::add_material(const material::Material& material) {
  if (const auto fault = material::find_fault(material))
    return core::Error{"material '" + material.name + "': " + *fault};
  state_->materials.push_back(material);
  return static_cast<int>(state_->materials.size()) - 1;
}

void World::add_pair(const PairOverride& pair) {
  if (!(pair.friction.value_or(0.0) >= 0.0 && pair.friction.value_or(0.0) <= kMostFriction) ||
      !(pair.restitution.value_or(0.0) >= 0.0 && pair.restitution.value_or(0.0) <= 1.0))
    throw std::invalid_argument("a pair's friction is 0 to 1e3, its restitution 0 to 1");
  const material::Material& a = material(pair.material_a);
  const material::Material& b = material(pair.material_b);
  body::Body body_a, body_b;
  body_a.friction = a.friction;
  body_a.restitution = a.restitution;
  body_b.friction = b.friction;
  body_b.restitution = b.restitution;
  const dynamics::PairMaterial usual = dynamics::pair_material(body_a, body_b, dynamics::ContactSettings{});
  state_->contact_settings.overrides.push_back({pair.material_a, pair.material_b,
                                                pair.friction.value_or(usual.friction),
                                                pair.restitution.value_or(usual.restitution)});
}

bool World::remove_body(body::BodyId id) {
  MovingState& moving = state_->moving;
  if (!body::find_body(moving.bodies, id)) return false;
  for (const dynamics::Joint& joint : moving.contact.joints) {
    if (joint.body_a != id && joint.body_b != id) continue;
    body::Body* other = body::find_body(moving.bodies, joint.body_a == id ? joint.body_b : joint.body_a);
    if (other->is_dynamic()) other->wake();
    moving.joint_memories.erase(joint.number);
  }
  std::erase_if(moving.contact.joints,
                [&](const dynamics::Joint& joint) { return joint.body_a == id || joint.body_b == id; });
  std::erase_if(moving.bodies, [&](const body::Body& b) { return b.id == id; });
  moving.memories.erase(id);
  moving.fragiles.erase(id);
  state_->element_stress.erase(id);
  state_->is_disturbed = true;
  return true;
}

bool World::push_body(body::BodyId id, const Vec3& impulse, const Vec3& point) {
  body::Body* body = body::find_body(state_->moving.bodies, id);
  if (!body || !body->is_dynamic()) return false;
  if (!impulse.allFinite() || !is_within(point, kMostLength)) return false;
  body::Body pushed = *body;
  pushed.push(impulse, point);
  if (!is_within(pushed.velocity, kMostSpeed) || !is_within(pushed.angular_velocity, kMostSpin)) return false;
  *body = std::move(pushed);
  body->wake();
  state_->is_disturbed = true;
  return true;
}

void World::set_gravity(const Vec3& gravity) {
  if (!is_within(gravity, kMostGravity)) throw std::invalid_argument("gravity is within 1e9 m/s2");
  state_->settings.gravity = state_->contact_settings.gravity = gravity;
  for (body::Body& body : state_->moving.bodies) {
    if (!body.is_dynamic()) continue;
    body.wake();
  }
  state_->is_disturbed = true;
}

bool World::explode(const dynamics::Blast& blast) {
  if (!is_within(blast.centre, kMostLength) || !is_positive(blast.energy, kMostEnergy) ||
      !(blast.duration >= 0.0 && blast.duration < 1e300))
    return false;
  state_->blasts.push_back(blast);
  return true;
}

int World::grab(body::BodyId id, const Vec3& point, double most_force) {
  const body::Body* body = body::find_body(state_->moving.bodies, id);
  if (!body || !body->is_dynamic()) return 0;
  if (!is_within(point, kMostLength) || !is_positive(most_force, kMostForce)) return 0;
  dynamics::Hand hand;
  hand.number = state_->next_hand++;
  hand.body = id;
  hand.grip = body->pose.apply_inverse(point);
  hand.attitude = body->pose.rotation;
  hand.place = point;
  hand.most_force = most_force;
  state_->hands.push_back(hand);
  return hand.number;
}

bool World::move_hand(int number, const Vec3& place) {
  if (!is_within(place, kMostLength)) return false;
  const auto hand = std::find_if(state_->hands.begin(), state_->hands.end(),
                                 [number](const dynamics::Hand& h) { return h.number == number; });
  if (hand == state_->hands.end() || !body::find_body(state_->moving.bodies, hand->body)) return false;
  const double steps_per_second = state_->settings.steps_per_second;
  const Vec3 before = hand->place - hand->velocity / steps_per_second;  // at the step's begin
  hand->velocity = (place - before) * steps_per_second;
  hand->place = place;
  return true;
}

void World::release(int number) {
  std::erase_if(state_->hands, [number](const dynamics::Hand& h) { return h.number == number; });
}

body::ImpulseLog World::act(const dynamics::StepPart& part) {
  State& s = *state_;
  body::ImpulseLog log;
  if (s.blasts.empty() && s.hands.empty()) return log;
  if (part.number == 0 && !s.blasts.empty())
    s.report.stages.time("explosions", [&] {
      for (const dynamics::Blast& blast : s.blasts) apply_blast(s.moving.bodies, blast, log);
    });
  if (!s.hands.empty())
    s.report.stages.time("hands", [&] {
      const double time_step = s.contact_settings.time_step / part.count;
      apply_hands(s.moving.bodies, s.hands, s.settings.gravity, time_step,
                  (part.count - 1 - part.number) * time_step, log);
    });
  s.is_disturbed = true;
  return log;
}

std::span<const body::Body> World::bodies() const {
  return state_->moving.bodies;
}

const material::Material& World::material(int number) const {
  return state_->materials.at(static_cast<std::size_t>(number));
}

Ancestry World::ancestry(body::BodyId id) const {
  const auto found = state_->ancestry.find(id);
  return found == state_->ancestry.end() ? Ancestry{} : found->second;
}

StressPicture World::stress_picture(body::BodyId id) const {
  StressPicture picture;
  const body::Body* body = body::find_body(state_->moving.bodies, id);
  const auto fragile = state_->moving.fragiles.find(id);
  if (!body || fragile == state_->moving.fragiles.end()) return picture;
  picture.strength = material::borne_tension(fragile->second->material());
  const auto stress = state_->element_stress.find(id);
  if (stress == state_->element_stress.end() || !stress->second) return picture;
  picture.triangle_stress = find_surface_stress(*body->shape, *fragile->second, *stress->second);
  return picture;
}

const WorldReport& World::report() const {
  return state_->report;
}

void World::keep_ways() {
  state_->contact_settings.has_ways = true;
}

std::span<const body::Way> World::ways() const {
  return state_->ways;
}
const body::ImpulseLog& World::impulse_log() const {
  return state_->log;
}
const WorldSettings& World::settings() const {
  return state_->settings;
}
long World::steps() const {
  return state_->steps;
}
double World::time() const {
  return static_cast<double>(state_->steps) / static_cast<double>(state_->settings.steps_per_second);
}
std::uint64_t World::state_hash() const {
  return state_->hash;
}

}  // namespace shatterbox::world
