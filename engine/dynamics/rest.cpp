// Sleep and waking. Who touches whom is kept by the pairs, also while they sleep. A body sleeps when it and
// all that it touches have been quiet; a disturbance wakes what it could move, from neighbour to neighbour.
#include "engine/dynamics/rest.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/core/disjoint_sets.h"
#include "engine/dynamics/motion_work.h"
#include "engine/dynamics/step_motion.h"

namespace shatterbox::dynamics {
namespace {

using body::Body;
using body::BodyId;

constexpr double kNoticed =
    10.0;  // times the least momentum: what gives a sleeper the speed of one who moves
constexpr double kFallTimes = 1.57;  // of sqrt(size / g): half a second for a metre
constexpr double kSmallFalls = 4.0;  // such times: half a second for 6 cm
constexpr double kMoreLoad = 0.1;    // of what a sleeper slept under: somebody has lain down on it
constexpr double kItAlone = std::numeric_limits<double>::min();  // kg m/s: wakes, and goes no further

int find_number(const std::vector<Body>& bodies, BodyId id) {
  const auto place =
      std::lower_bound(bodies.begin(), bodies.end(), id, [](const Body& b, BodyId i) { return b.id < i; });
  return place != bodies.end() && place->id == id ? static_cast<int>(place - bodies.begin()) : -1;
}

template <class State>
auto* find_memory(State& state, BodyId id) {
  const auto place = std::lower_bound(state.bodies.begin(), state.bodies.end(), id,
                                      [](const BodyState& s, BodyId i) { return s.id < i; });
  return place != state.bodies.end() && place->id == id ? &*place : nullptr;
}

double quiet_speed(const ContactSettings& settings, double reach) {
  return 0.5 * std::sqrt(settings.gravity.norm() * settings.kept_gap * 2.0 * reach);
}

// Quiet for that long it is at rest, s: what tips, or swings, needs the longer to be seen at it the larger it
// is. What is small shows soon that it does not.
double time_to_rest(const ContactSettings& settings, const Body& b) {
  const double g = settings.gravity.norm();
  if (g == 0.0) return settings.sleep_time;
  const double fall = kFallTimes * std::sqrt(2.0 * b.shape->bounding_radius / g);
  return std::max(fall, std::min(settings.sleep_time, kSmallFalls * fall));
}

// No point of the body is further from where it was at `rest` than six of its usual gaps.
bool stays_near(const ContactSettings& settings, const Body& b, const Pose& rest) {
  const double reach = b.shape->bounding_radius;
  const double apart = std::min((b.pose.rotation.coeffs() - rest.rotation.coeffs()).norm(),
                                (b.pose.rotation.coeffs() + rest.rotation.coeffs()).norm());
  const double moved = (b.pose.translation - rest.translation).norm() + 2.0 * apart * reach;
  return moved <= 6.0 * settings.kept_gap * 2.0 * reach;
}

// The momentum, kg m/s, below which a body is hardly disturbed: it would get a tenth of what still counts as
// rest.
double least_momentum(const ContactSettings& settings, const Body& b) {
  return 0.1 * quiet_speed(settings, b.shape->bounding_radius) / b.inverse_mass;
}

// The dynamic bodies that touch each, asleep or not.
std::vector<std::vector<int>> find_neighbours(const std::vector<Body>& bodies, const ContactState& state) {
  std::vector<std::vector<int>> neighbours(bodies.size());
  for (const PairState& pair : state.pairs) {
    if (!pair.is_touching) continue;
    const int a = find_number(bodies, pair.body_a), b = find_number(bodies, pair.body_b);
    if (a < 0 || b < 0) continue;
    if (!bodies[static_cast<std::size_t>(a)].is_dynamic() ||
        !bodies[static_cast<std::size_t>(b)].is_dynamic())
      continue;
    neighbours[static_cast<std::size_t>(a)].push_back(b);
    neighbours[static_cast<std::size_t>(b)].push_back(a);
  }
  return neighbours;
}

// Of each body those that a joint holds to it.
std::vector<std::vector<int>> find_joined(const std::vector<Body>& bodies, const ContactState& state) {
  std::vector<std::vector<int>> joined(bodies.size());
  for (const Joint& joint : state.joints) {
    const int a = find_number(bodies, joint.body_a), b = find_number(bodies, joint.body_b);
    if (a < 0 || b < 0) continue;
    joined[static_cast<std::size_t>(a)].push_back(b);
    joined[static_cast<std::size_t>(b)].push_back(a);
  }
  return joined;
}

// Marks all that dynamic bodies which are marked hold by joints, from one to the next.
void mark_joined(const std::vector<Body>& bodies, const ContactState& state, std::vector<char>& marks) {
  if (state.joints.empty()) return;
  const auto joined = find_joined(bodies, state);
  std::vector<int> marked;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (marks[i] && bodies[i].is_dynamic()) marked.push_back(static_cast<int>(i));
  }
  for (std::size_t next = 0; next < marked.size(); ++next) {
    for (const int i : joined[static_cast<std::size_t>(marked[next])]) {
      if (marks[static_cast<std::size_t>(i)] || !bodies[static_cast<std::size_t>(i)].is_dynamic()) continue;
      marks[static_cast<std::size_t>(i)] = 1;
      marked.push_back(i);
    }
  }
}

double slept_under(const ContactState& state, BodyId id) {
  const BodyState* memory = find_memory(state, id);
  return memory != nullptr ? memory->slept_under : 0.0;
}

// Wakes the sleepers that a disturbance reaches: those it begins with, and from neighbour to neighbour, the
// nearest first, as many as its momentum (kg m/s; 0: is not disturbed) could move noticeably all together.
// Who moves in truth wakes others in the next step.
void rouse(std::vector<Body>& bodies, const ContactSettings& settings, const ContactState& state,
           std::vector<double> momentum) {
  struct Roused {
    int body, origin;
  };
  std::vector<Roused> roused;
  const auto wake = [&](int i, int origin) {
    Body& b = bodies[static_cast<std::size_t>(i)];
    if (!b.sleeps()) return;
    b.wake();
    roused.push_back({i, origin});
  };
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (momentum[i] > 0.0) wake(static_cast<int>(i), static_cast<int>(i));
  }
  if (roused.empty()) return;
  const auto neighbours = find_neighbours(bodies, state), joined = find_joined(bodies, state);
  for (std::size_t next = 0; next < roused.size(); ++next) {
    const auto [by, origin] = roused[next];
    double& left = momentum[static_cast<std::size_t>(origin)];
    for (const int i : neighbours[static_cast<std::size_t>(by)]) {
      const Body& b = bodies[static_cast<std::size_t>(i)];
      if (!b.sleeps() || left < least_momentum(settings, b)) continue;
      left -= least_momentum(settings, b);
      wake(i, origin);
    }
    // What is one with it moves with it.
    for (const int i : joined[static_cast<std::size_t>(by)]) wake(i, origin);
  }
}

// Where nothing may, nobody asks for loads.
bool may_any_break(const std::vector<Body>& bodies) {
  return std::any_of(bodies.begin(), bodies.end(), [](const Body& b) { return b.may_break; });
}

// N, what presses on each body at rest.
std::vector<double> find_loads(const std::vector<Body>& bodies, const ContactState& state) {
  std::vector<double> loads(bodies.size(), 0.0);
  for (const PairState& pair : state.pairs) {
    if (!pair.is_touching) continue;
    for (const BodyId id : {pair.body_a, pair.body_b})
      if (const int i = find_number(bodies, id); i >= 0) loads[static_cast<std::size_t>(i)] += pair.load;
  }
  return loads;
}

// Both ways round: one of the two, and the other, by their numbers. Nothing if one is not there.
template <class Two, class Visit>
void each_of_two(const std::vector<Body>& bodies, const Two& two, const Visit& visit) {
  const int a = find_number(bodies, two.body_a), b = find_number(bodies, two.body_b);
  if (a < 0 || b < 0) return;
  visit(static_cast<std::size_t>(a), static_cast<std::size_t>(b));
  visit(static_cast<std::size_t>(b), static_cast<std::size_t>(a));
}

// Whether what lies on the first body may, by way of others, press on the second one: as far as the balls
// about them tell, and loads spread by no more than they go down.
bool may_bear(const Body& above, const Body& below, const Vec3& up) {
  const double reach = above.shape->bounding_radius + below.shape->bounding_radius;
  const Vec3 way = above.pose.translation - below.pose.translation;
  const double height = way.dot(up);
  return height >= -reach && (way - height * up).norm() <= reach + std::max(0.0, height);
}

// Sleepers pass nothing on. Where somebody has lain down on one, and what lies below it may break by all that
// came there since they fell asleep, that has to feel it, and so wakes with all that it may bear.
void wake_overloaded(const std::vector<Body>& bodies, const Vec3& gravity, const ContactState& state,
                     std::vector<double>& momentum) {
  const Vec3 up = -gravity.normalized();
  const std::vector<double> loads = find_loads(bodies, state);
  std::vector<double> more(bodies.size(), 0.0);  // N, on a sleeper
  for (std::size_t i = 0; i < bodies.size(); ++i)
    if (bodies[i].sleeps()) more[i] = std::max(0.0, loads[i] - slept_under(state, bodies[i].id));
  core::DisjointSets heaps(bodies.size());
  std::vector<std::size_t> pressed;
  const auto lies = [](const Body& b) { return b.sleeps() || (!b.is_dynamic() && b.may_break); };
  for (const PairState& pair : state.pairs) {
    if (!pair.is_touching) continue;
    each_of_two(bodies, pair, [&](std::size_t one, std::size_t other) {
      const Body &sleeper = bodies[one], &mover = bodies[other];
      if (lies(sleeper) && lies(mover)) heaps.unite(static_cast<int>(one), static_cast<int>(other));
      const bool is_laden = sleeper.sleeps() && mover.is_dynamic() && mover.is_awake;
      if (is_laden && more[one] > kMoreLoad * (loads[one] - more[one])) pressed.push_back(one);
    });
  }
  const auto heap_of = [&](std::size_t i) { return heaps.find(static_cast<int>(i)); };
  const auto lies_on = [&](std::size_t i, std::size_t below) {
    return heap_of(i) == heap_of(below) && may_bear(bodies[i], bodies[below], up);
  };
  for (std::size_t below = 0; below < bodies.size() && !pressed.empty(); ++below) {
    const Body& b = bodies[below];
    if (!b.may_break || !lies(b)) continue;
    if (std::none_of(pressed.begin(), pressed.end(), [&](std::size_t i) { return lies_on(i, below); }))
      continue;
    double came = 0.0;  // N
    for (std::size_t i = 0; i < bodies.size(); ++i)
      if (more[i] > 0.0 && lies_on(i, below)) came += more[i];
    // What presses from above does from below.
    if (loads[below] + 2.0 * came <= b.bears) continue;
    for (std::size_t i = 0; i < bodies.size(); ++i)
      if (bodies[i].sleeps() && lies_on(i, below)) momentum[i] = std::max(momentum[i], kItAlone);
  }
}

// Those that are being brought out of another, which leaves them no speed.
std::vector<char> find_parting(const std::vector<Body>& bodies, const ContactState& state) {
  std::vector<char> is_parting(bodies.size(), 0);
  for (const PairState& pair : state.pairs) {
    if (!pair.is_exempt) continue;
    for (const BodyId id : {pair.body_a, pair.body_b})
      if (const int i = find_number(bodies, id); i >= 0) is_parting[static_cast<std::size_t>(i)] = 1;
  }
  return is_parting;
}

// Whether anyone has been quiet for long enough.
bool count_quiet_times(std::vector<Body>& bodies, const ContactSettings& settings, ContactState& state) {
  const std::vector<char> is_parting = find_parting(bodies, state);
  bool is_anyone_tired = false;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    Body& b = bodies[i];
    if (!b.is_dynamic() || !b.is_awake) continue;
    const bool is_still =
        !is_parting[i] && is_quiet(settings, b.velocity, b.angular_velocity, b.shape->bounding_radius);
    // Or it trembles in a nest, without getting anywhere.
    BodyState* memory = find_memory(state, b.id);
    const bool stays = memory != nullptr && stays_near(settings, b, memory->rest_pose);
    if (!stays && memory != nullptr) memory->rest_pose = b.pose;
    b.quiet_time = is_still || stays ? b.quiet_time + settings.time_step : 0.0;
    is_anyone_tired = is_anyone_tired || b.quiet_time >= time_to_rest(settings, b);
  }
  return is_anyone_tired;
}

// Who touches something, or hangs on what cannot move.
std::vector<char> find_held(const std::vector<Body>& bodies, const ContactState& state) {
  std::vector<char> is_held(bodies.size(), 0);
  for (const PairState& pair : state.pairs) {
    if (!pair.is_touching) continue;
    for (const BodyId id : {pair.body_a, pair.body_b})
      if (const int i = find_number(bodies, id); i >= 0) is_held[static_cast<std::size_t>(i)] = 1;
  }
  for (const Joint& joint : state.joints)
    each_of_two(bodies, joint, [&](std::size_t one, std::size_t other) {
      if (!bodies[other].is_dynamic()) is_held[one] = 1;
    });
  mark_joined(bodies, state, is_held);
  return is_held;
}

// Who has no rest yet; who touches nothing must not sleep in the air.
std::vector<char> find_restless(const std::vector<Body>& bodies, const ContactSettings& settings,
                                const ContactState& state) {
  const bool is_weightless = settings.gravity.squaredNorm() == 0.0;
  const std::vector<char> is_held = find_held(bodies, state);
  std::vector<char> is_restless(bodies.size(), 0);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Body& b = bodies[i];
    if (!b.is_dynamic() || !b.is_awake) continue;
    is_restless[i] = b.quiet_time < time_to_rest(settings, b) || (!is_held[i] && !is_weightless) ? 1 : 0;
  }
  mark_joined(bodies, state, is_restless);
  return is_restless;
}

// They, and who touches somebody that has no rest yet and could move it, or goes on by itself.
std::vector<char> find_kept_up(const std::vector<Body>& bodies, const ContactSettings& settings,
                               const ContactState& state) {
  const std::vector<char> is_restless = find_restless(bodies, settings, state);
  std::vector<char> is_kept_up = is_restless;
  for (const PairState& pair : state.pairs) {
    if (!pair.is_touching) continue;
    each_of_two(bodies, pair, [&](std::size_t one, std::size_t other) {
      if (bodies[one].is_driven() || (is_restless[one] && bodies[other].is_dynamic() &&
                                      could_move(settings, bodies[one], bodies[other])))
        is_kept_up[other] = 1;
    });
  }
  for (const Joint& joint : state.joints)
    each_of_two(bodies, joint, [&](std::size_t one, std::size_t other) {
      if (bodies[one].is_driven()) is_kept_up[other] = 1;
    });
  mark_joined(bodies, state, is_kept_up);
  return is_kept_up;
}

}  // namespace

double impact_threshold(const ContactSettings& settings, double kept_gap) {
  const double g = settings.gravity.norm();
  // Without gravity anything that closes is an impact; what is left over is far below a gap a step.
  return 2.0 * g * settings.time_step + std::sqrt(8.0 * g * kept_gap) + 1e-3 * kept_gap / settings.time_step;
}

double greatest_speed(const Vec3& velocity, const Vec3& spin, double reach) {
  return velocity.norm() + spin.norm() * reach;
}

bool is_quiet(const ContactSettings& settings, const Vec3& velocity, const Vec3& spin, double reach) {
  return greatest_speed(velocity, spin, reach) <= quiet_speed(settings, reach);
}

bool could_move(const ContactSettings& settings, const Body& mover, const Body& sleeper) {
  const double reach = mover.shape->bounding_radius;
  const double speed =
      std::max(quiet_speed(settings, reach), greatest_speed(mover.velocity, mover.angular_velocity, reach));
  return speed >= mover.inverse_mass * least_momentum(settings, sleeper);
}

void wake_bodies(std::vector<Body>& bodies, const ContactSettings& settings, ContactState& state) {
  constexpr double kAll = std::numeric_limits<double>::infinity();

  std::vector<double> momentum(bodies.size(), 0.0);
  bool has_sleepers = false;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Body& b = bodies[i];
    if (!b.sleeps()) continue;
    has_sleepers = true;
    // A push, by the script or by a stage that gives impulses.
    if (b.velocity.squaredNorm() + b.angular_velocity.squaredNorm() > 0.0) momentum[i] = kAll;
  }
  if (!has_sleepers) return;
  for (const PairState& pair : state.pairs) {
    if (!pair.is_touching && !pair.has_parted) continue;
    const int ends[2] = {find_number(bodies, pair.body_a), find_number(bodies, pair.body_b)};
    for (int k = 0; k < 2; ++k) {
      if (ends[k] < 0 || bodies[static_cast<std::size_t>(ends[k])].is_awake) continue;
      double& given = momentum[static_cast<std::size_t>(ends[k])];
      // What it leaned on has gone away, or is a support that moves.
      if (pair.has_parted) given = std::max(given, kItAlone);
      const int other = ends[1 - k];
      bool moves = other < 0;
      if (other >= 0) {
        const Body& o = bodies[static_cast<std::size_t>(other)];
        moves = o.is_driven();
      }
      if (moves) given = kAll;
    }
  }
  if (may_any_break(bodies)) wake_overloaded(bodies, settings.gravity, state, momentum);
  // Who was woken alone, by a joint that opened or because what bore him is gone, wakes all that hang on him,
  // and so does a support that begins to move.
  for (const Joint& joint : state.joints) {
    const int ends[2] = {find_number(bodies, joint.body_a), find_number(bodies, joint.body_b)};
    for (int k = 0; k < 2; ++k) {
      if (ends[k] < 0 || ends[1 - k] < 0) continue;
      const Body &one = bodies[static_cast<std::size_t>(ends[k])],
                 &other = bodies[static_cast<std::size_t>(ends[1 - k])];
      double& given = momentum[static_cast<std::size_t>(ends[k])];
      if (!one.is_awake && (other.is_driven() || (other.is_dynamic() && other.is_awake)))
        given = std::max(given, kItAlone);
    }
  }
  rouse(bodies, settings, state, std::move(momentum));
}

double closing_on_sleeper(const WorkBody& mover, const collision::Contact& contact, bool sleeper_is_a) {
  const Vec3 arm = (sleeper_is_a ? contact.on_b : contact.on_a) - mover.start.translation;
  const Vec3 towards = sleeper_is_a ? contact.normal : Vec3(-contact.normal);
  return towards.dot(mover.velocity + mover.spin.cross(arm));
}

void find_struck_sleepers(const std::vector<Body>& bodies, const ContactSettings& settings,
                          const std::vector<char>& slept, const std::vector<SleeperHit>& hits,
                          MotionWork& work) {
  const auto sleeps = [&](int i) { return bodies[static_cast<std::size_t>(i)].sleeps(); };
  // Who was himself woken in this step passes on what others give him; of all others a hit alone wakes.
  const auto note = [&](const WorkPair& pair, double closing, double momentum) {
    const bool a_sleeps = sleeps(pair.a);
    const Body& sleeper = bodies[static_cast<std::size_t>(a_sleeps ? pair.a : pair.b)];
    const bool was_woken = slept[static_cast<std::size_t>(a_sleeps ? pair.b : pair.a)] != 0;
    if (closing > pair.threshold || (was_woken && momentum > kNoticed * least_momentum(settings, sleeper)))
      work.to_wake.push_back({sleeper.id, momentum});
  };
  for (const SolverContact& c : work.contacts) {
    if (sleeps(c.a) == sleeps(c.b) || c.was_loaded) continue;
    note(work.pairs[static_cast<std::size_t>(c.pair)], c.closing_speed, c.total.norm());
  }
  for (const SleeperHit& hit : hits) {
    const WorkPair& pair = work.pairs[static_cast<std::size_t>(hit.pair)];
    if (sleeps(pair.a) == sleeps(pair.b)) continue;
    const WorkBody& mover = work.bodies[static_cast<std::size_t>(sleeps(pair.a) ? pair.b : pair.a)];
    if (!(mover.inverse_mass > 0.0)) continue;
    const double closing = closing_on_sleeper(mover, hit.contact, sleeps(pair.a));
    note(pair, closing, std::max(0.0, closing) / mover.inverse_mass);
  }
}

void wake_struck(std::vector<Body>& bodies, const ContactSettings& settings, const ContactState& state,
                 const std::vector<Disturbance>& disturbances) {
  std::vector<double> momentum(bodies.size(), 0.0);
  for (const Disturbance& d : disturbances) {
    double& given = momentum[static_cast<std::size_t>(find_number(bodies, d.body))];
    given = std::max({given, d.momentum, kItAlone});
  }
  rouse(bodies, settings, state, std::move(momentum));
}

void put_to_sleep(std::vector<Body>& bodies, const ContactSettings& settings, ContactState& state) {
  if (!settings.has_sleep || !count_quiet_times(bodies, settings, state)) return;
  const std::vector<char> is_kept_up = find_kept_up(bodies, settings, state);
  const std::vector<double> loads = may_any_break(bodies) ? find_loads(bodies, state) : std::vector<double>{};
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    Body& b = bodies[i];
    if (!b.is_dynamic() || !b.is_awake || is_kept_up[i]) continue;
    b.is_awake = false;
    if (BodyState* memory = find_memory(state, b.id); memory != nullptr && !loads.empty())
      memory->slept_under = loads[i];
    b.velocity.setZero();
    b.angular_velocity.setZero();
  }
}

}  // namespace shatterbox::dynamics
