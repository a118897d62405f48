// Sleep and waking. Islands are kept by the pairs that touch, also while they sleep.
#include "engine/dynamics/rest.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/dynamics/step_motion.h"

namespace shatterbox::dynamics {
namespace {

using body::Body;
using body::BodyId;

int find_number(const std::vector<Body>& bodies, BodyId id) {
  const auto place =
      std::lower_bound(bodies.begin(), bodies.end(), id, [](const Body& b, BodyId i) { return b.id < i; });
  return place != bodies.end() && place->id == id ? static_cast<int>(place - bodies.begin()) : -1;
}

BodyState* find_memory(ContactState& state, BodyId id) {
  const auto place = std::lower_bound(state.bodies.begin(), state.bodies.end(), id,
                                      [](const BodyState& s, BodyId i) { return s.id < i; });
  return place != state.bodies.end() && place->id == id ? &*place : nullptr;
}

// No point of the body is further from where it was at `rest` than six of its usual gaps.
bool stays_near(const ContactSettings& settings, const Body& b, const Pose& rest) {
  const double reach = b.shape->bounding_radius;
  const double apart = std::min((b.pose.rotation.coeffs() - rest.rotation.coeffs()).norm(),
                                (b.pose.rotation.coeffs() + rest.rotation.coeffs()).norm());
  const double moved = (b.pose.translation - rest.translation).norm() + 2.0 * apart * reach;
  return moved <= 6.0 * settings.kept_gap * 2.0 * reach;
}

// Islands of dynamic bodies that touch, asleep or not: the least number in each.
std::vector<int> find_islands(const std::vector<Body>& bodies, const ContactState& state) {
  std::vector<int> parent(bodies.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int i) {
    while (parent[static_cast<std::size_t>(i)] != i) i = parent[static_cast<std::size_t>(i)];
    return i;
  };
  for (const PairState& pair : state.pairs) {
    if (!pair.is_touching) continue;
    const int a = find_number(bodies, pair.body_a), b = find_number(bodies, pair.body_b);
    if (a < 0 || b < 0) continue;
    if (!bodies[static_cast<std::size_t>(a)].is_dynamic() ||
        !bodies[static_cast<std::size_t>(b)].is_dynamic())
      continue;
    const int ra = root(a), rb = root(b);
    parent[static_cast<std::size_t>(std::max(ra, rb))] = std::min(ra, rb);
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) parent[i] = root(static_cast<int>(i));
  return parent;
}

// Wakes the sleepers of every island that has a roused body in it.
void rouse(std::vector<Body>& bodies, const ContactState& state, const std::vector<char>& is_roused) {
  if (std::find(is_roused.begin(), is_roused.end(), 1) == is_roused.end()) return;
  const std::vector<int> islands = find_islands(bodies, state);
  std::vector<char> island_roused(bodies.size(), 0);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (is_roused[i]) island_roused[static_cast<std::size_t>(islands[i])] = 1;
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (!bodies[i].is_dynamic() || bodies[i].is_awake || !island_roused[static_cast<std::size_t>(islands[i])])
      continue;
    bodies[i].is_awake = true;
    bodies[i].quiet_time = 0.0;
  }
}

}  // namespace

double impact_threshold(const ContactSettings& settings, double kept_gap) {
  const double g = settings.gravity.norm();
  // Without gravity anything that closes is an impact; what is left over is far below a gap a step.
  return 2.0 * g * settings.time_step + std::sqrt(8.0 * g * kept_gap) + 1e-3 * kept_gap / settings.time_step;
}

bool is_quiet(const ContactSettings& settings, const Vec3& velocity, const Vec3& spin, double reach) {
  const double limit = std::sqrt(settings.gravity.norm() * settings.kept_gap * 2.0 * reach);
  return velocity.norm() + spin.norm() * reach <= 0.5 * limit;
}

void wake_bodies(std::vector<Body>& bodies, const ContactSettings& settings, ContactState& state) {
  std::vector<char> is_roused(bodies.size(), 0);
  bool has_sleepers = false;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    Body& b = bodies[i];
    if (!b.is_dynamic() || b.is_awake) continue;
    has_sleepers = true;
    // A push, by the script or by a stage that gives impulses.
    if (b.velocity.squaredNorm() + b.angular_velocity.squaredNorm() > 0.0) is_roused[i] = 1;
  }
  if (!has_sleepers) return;
  for (const PairState& pair : state.pairs) {
    if (!pair.is_touching) continue;
    const int ends[2] = {find_number(bodies, pair.body_a), find_number(bodies, pair.body_b)};
    for (int k = 0; k < 2; ++k) {
      if (ends[k] < 0 || bodies[static_cast<std::size_t>(ends[k])].is_awake) continue;
      const int other = ends[1 - k];
      // The partner is gone, or is a support that moves.
      bool moves = other < 0;
      if (other >= 0) {
        const Body& o = bodies[static_cast<std::size_t>(other)];
        moves = o.motion == body::Motion::scripted &&
                !is_quiet(settings, o.velocity, o.angular_velocity, o.shape->bounding_radius);
      }
      if (moves) is_roused[static_cast<std::size_t>(ends[k])] = 1;
    }
  }
  rouse(bodies, state, is_roused);
}

void wake_island(std::vector<Body>& bodies, const ContactState& state, Body& sleeper) {
  std::vector<char> is_roused(bodies.size(), 0);
  is_roused[static_cast<std::size_t>(&sleeper - bodies.data())] = 1;
  rouse(bodies, state, is_roused);
}

void put_to_sleep(std::vector<Body>& bodies, const ContactSettings& settings, ContactState& state) {
  if (!settings.has_sleep) return;
  std::vector<char> is_held(bodies.size(), 0);
  bool anyone_tired = false;
  for (Body& b : bodies) {
    if (!b.is_dynamic() || !b.is_awake) continue;
    const bool is_still = is_quiet(settings, b.velocity, b.angular_velocity, b.shape->bounding_radius);
    // Or it trembles in a nest, without getting anywhere.
    BodyState* memory = find_memory(state, b.id);
    const bool stays = memory != nullptr && stays_near(settings, b, memory->rest_pose);
    if (!stays && memory != nullptr) memory->rest_pose = b.pose;
    b.quiet_time = is_still || stays ? b.quiet_time + settings.time_step : 0.0;
    anyone_tired = anyone_tired || b.quiet_time >= settings.sleep_time;
  }
  if (!anyone_tired) return;
  // Who touches nothing must not sleep in the air.
  for (const PairState& pair : state.pairs) {
    if (!pair.is_touching) continue;
    for (const BodyId id : {pair.body_a, pair.body_b}) {
      if (const int i = find_number(bodies, id); i >= 0) is_held[static_cast<std::size_t>(i)] = 1;
    }
  }
  const bool is_weightless = settings.gravity.squaredNorm() == 0.0;
  const std::vector<int> islands = find_islands(bodies, state);
  std::vector<char> is_restless(bodies.size(), 0);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Body& b = bodies[i];
    if (!b.is_dynamic() || !b.is_awake) continue;
    if (b.quiet_time < settings.sleep_time || (!is_held[i] && !is_weightless)) {
      is_restless[static_cast<std::size_t>(islands[i])] = 1;
    }
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    Body& b = bodies[i];
    if (!b.is_dynamic() || !b.is_awake || is_restless[static_cast<std::size_t>(islands[i])]) continue;
    b.is_awake = false;
    b.velocity.setZero();
    b.angular_velocity.setZero();
  }
}

}  // namespace shatterbox::dynamics
