#include "engine/dynamics/step_motion.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "engine/core/buckets.h"
#include "engine/core/index.h"
#include "engine/core/parallel.h"
#include "engine/dynamics/contact_solver.h"
#include "engine/dynamics/joint_work.h"
#include "engine/dynamics/motion_work.h"
#include "engine/dynamics/parting.h"
#include "engine/dynamics/rest.h"
#include "engine/dynamics/scripted_motion.h"

namespace shatterbox::dynamics {
namespace {

using body::Body;
using body::ImpulseKind;
using core::at;

// A step with newborn pieces is taken in at least so many parts, none longer than this. It is divided as far
// as that, but no further than it takes, after one in which, of so many bodies that are near others, more
// than one turns far and, of so many, more than one pair was hit in which one does.
constexpr int kLeastParts = 4;
constexpr double kPartTime = 1.0 / 960.0;  // s
constexpr double kMostParts = 512.0;
constexpr int kManySpin = 20;
constexpr int kManyHits = 30;
constexpr int kManyCut = 200;        // a part in which, of so many of them, more than one was cut short
constexpr int kFiner = 4;            // goes on in so many times as many, as does the step after it
constexpr double kAsideTime = 1e-9;  // of a part: what is set aside is so at once

// Links of a chain that is pulled taut swing by no more than this in a substep, rad: beyond it they win
// energy.
constexpr double kSwingTurn = 0.5;
constexpr double kTorn = 1e-3;      // of the lesser reach: what is off by more has been torn
constexpr double kMostFiner = 8.0;  // times as many substeps at most: the pull of a blow does not last

body::LoggedImpulse describe(const std::vector<Body>& bodies, const SolverContact& c,
                             const GivenImpulse& given, const Vec3& total) {
  body::LoggedImpulse entry;
  const bool has_place = given.moment_weight > 0.0;
  entry.body_a = bodies[at(c.a)].id;
  entry.body_b = bodies[at(c.b)].id;
  entry.point_world = has_place ? Vec3(given.moment_point / given.moment_weight) : c.point;
  if (has_place) {
    entry.point_a = given.moment_a / given.moment_weight;
    entry.point_b = given.moment_b / given.moment_weight;
  } else {
    entry.point_a = bodies[at(c.a)].pose.apply_inverse(c.point);
    entry.point_b = bodies[at(c.b)].pose.apply_inverse(c.point);
  }
  entry.impulse_a = given.impulse_a;
  entry.impulse_b = given.impulse_b;
  entry.normal_world = c.normal;
  entry.impulse_world = total;
  entry.effective_mass = c.effective_mass > 0.0 ? c.effective_mass : c.weights[0];
  return entry;
}

void mark_hit(double closing_speed, double time, body::LoggedImpulse& entry) {
  entry.kind = ImpulseKind::collision;
  entry.closing_speed = closing_speed;
  entry.time = time;
}

// Where nothing may break, what arrived in a step is logged as it was at its end.
void log_contacts(const std::vector<Body>& bodies, const MotionWork& work, body::ImpulseLog& log) {
  std::vector<char> pair_collides(work.pairs.size(), 0);
  std::vector<std::pair<const SolverContact*, std::size_t>> logged;  // and where its first entry goes
  std::size_t end = log.size();
  for (const SolverContact& c : work.contacts) {
    if (c.closing_speed > c.threshold && !c.was_loaded && !c.tells_hits) pair_collides[at(c.pair)] = 1;
    // Of what sweeps gave and took back `total` keeps the rounding; the bodies felt nothing.
    const std::size_t entries = c.hits.size() + (c.given.is_any() ? 1 : 0);
    if (entries > 0) logged.emplace_back(&c, end);
    end += entries;
  }
  log.resize(end);
  core::parallel_for(logged.size(), 64, [&](std::size_t k) {
    const SolverContact& c = *logged[k].first;
    std::size_t next = logged[k].second;
    Vec3 rest = c.total;
    for (const ContactHit& hit : c.hits) {
      log[next] = describe(bodies, c, hit.given, hit.total);
      if (hit.effective_mass > 0.0) log[next].effective_mass = hit.effective_mass;
      mark_hit(hit.closing_speed, hit.arrival_time, log[next++]);
      rest -= hit.total;
    }
    if (!c.given.is_any()) return;
    log[next] = describe(bodies, c, c.given, rest);
    if (pair_collides[at(c.pair)] && !c.was_loaded) mark_hit(c.closing_speed, c.arrival_time, log[next]);
  });
  log.insert(log.end(), work.continuous_log.begin(), work.continuous_log.end());
}

void remember_contact(const SolverContact& c, PairState& memory) {
  const bool is_loaded = c.given.is_any() || !c.hits.empty();
  memory.is_touching = memory.is_touching || is_loaded || c.slack <= c.kept_gap;
  const Vec3 crept = is_loaded ? Vec3(c.change - c.held_from) : Vec3::Zero();
  memory.contacts.push_back({c.found.key, c.warm[0], c.warm[1] * c.tangent_u + c.warm[2] * c.tangent_v,
                             crept - c.normal.dot(crept) * c.normal, c.arrival_speed, is_loaded, c.hit_left});
}

double load_of(const PairState& pair, double substep) {
  double impulse = 0.0;
  for (const RememberedContact& c : pair.contacts) impulse += c.normal_impulse;
  return impulse / substep;
}

void remember_contacts(const MotionWork& work, ContactState& state) {
  state.substep = work.substep;
  const bool may_break =
      std::any_of(work.bodies.begin(), work.bodies.end(), [](const WorkBody& w) { return w.may_break; });
  const core::Buckets contacts(work.pairs.size(), work.contacts.size(),
                               [&](std::size_t i) { return work.contacts[i].pair; });
  core::parallel_for(work.pairs.size(), 64, [&](std::size_t p) {
    const WorkPair& pair = work.pairs[p];
    PairState& memory = state.pairs[at(pair.state)];
    memory.has_parted = memory.was_loaded();
    memory.contacts.clear();
    memory.is_touching = false;
    memory.trouble_age = std::min(memory.trouble_age + 1, kNoTrouble);
    const WorkBody &a = work.bodies[at(pair.a)], &b = work.bodies[at(pair.b)];
    // A sleeper and what lies on it quietly keep their memory through its sleep.
    if (a.inverse_mass == 0.0 && b.inverse_mass == 0.0) {
      for (const auto& c : pair.contacts)
        memory.is_touching = memory.is_touching || c.gap <= 2.0 * pair.kept_gap;
    }
    for (const int i : contacts.of(p)) remember_contact(work.contacts[at(i)], memory);
    if (may_break && (a.inverse_mass > 0.0 || b.inverse_mass > 0.0))
      memory.load = load_of(memory, work.substep);
    memory.has_parted = memory.has_parted && !memory.is_touching;
    // What was found on the way came last.
    const auto by_key = [](const RememberedContact& x, const RememberedContact& y) {
      return x.feature_key < y.feature_key;
    };
    if (!std::is_sorted(memory.contacts.begin(), memory.contacts.end(), by_key))
      std::sort(memory.contacts.begin(), memory.contacts.end(), by_key);
  });
}

void report_contacts(const MotionWork& work, ContactState& state, ContactReport& report) {
  report.solver_contacts = static_cast<int>(work.contacts.size());
  for (const WorkPair& pair : work.pairs) {
    PairState& memory = state.pairs[at(pair.state)];
    if (!memory.is_exempt) {
      report.least_gap = std::min(report.least_gap, pair.least_gap);
      continue;
    }
    ++report.crossing_pairs;
    if (!memory.is_reported) report.new_crossing_pairs.emplace_back(memory.body_a, memory.body_b);
    memory.is_reported = true;
  }
  for (const SolverContact& c : work.contacts) {
    if (c.slack > c.kept_gap) continue;
    ++report.contacts;
    if (c.impulse[0] <= 0.0) continue;
    const WorkBody &a = work.bodies[at(c.a)], &b = work.bodies[at(c.b)];
    const Vec3 u = a.velocity + a.spin.cross(c.arm_a) - b.velocity - b.spin.cross(c.arm_b);
    report.residual = std::max(report.residual, -c.normal.dot(u));
  }
  for (const WorkBody& b : work.bodies) report.awake_bodies += b.is_active && b.inverse_mass > 0.0 ? 1 : 0;
  report.failsafe_steps = work.failsafe_bodies;
  if (report.awake_bodies > 0)
    report.frozen_share = static_cast<double>(work.failsafe_bodies) / report.awake_bodies;
}

// A body that turns far is followed through where it was in between.
void keep_knots(const std::vector<Pose>& poses, WorkBody& w) {
  w.knots.clear();
  w.straight_parts = count_straight_parts(w.turn_angle);
  if (!turns_far(w)) return;
  w.knots.push_back(w.start);
  w.knots.insert(w.knots.end(), poses.begin(), poses.end());
  w.knots.back() = w.end;
}

void end_in_contact(WorkBody& w) {
  w.end.translation = w.start.translation + w.way;
  w.end.rotation = w.rotation;
  keep_knots(w.substep_poses, w);
}

// Nothing was solved or opened yet.
void begin_freely(const ContactSettings& settings, WorkBody& w) {
  w.velocity = w.velocity_start;
  w.spin = w.spin_start;
  w.turn_angle = free_turn_angle(w, settings.time_step);
  w.is_free = true;
}

void end_freely(bool is_dynamic, const ContactSettings& settings, WorkBody& w) {
  if (is_dynamic) begin_freely(settings, w);
  w.end = w.predicted;
  w.end.translation += w.fall_left_out;  // nothing bears it any more
  w.straight_parts = count_straight_parts(w.turn_angle);
  if (turns_far(w)) {
    // The centre goes straight: that is what the pair's meeting was told.
    const Vec3 way = w.end.translation - w.start.translation;
    std::vector<Pose> poses;
    Quat rotation = w.start.rotation;
    Vec3 spin = w.spin;
    const int parts = w.straight_parts;
    for (int k = 0; k < parts; ++k) {
      if (is_dynamic)
        advance_turning(w, settings.time_step / parts, rotation, spin);
      else
        rotation = (rotation_by(settings.time_step / parts * w.spin) * rotation).normalized();
      poses.push_back({rotation, w.start.translation + (k + 1.0) / parts * way});
    }
    keep_knots(poses, w);
  }
  if (!is_dynamic) return;
  w.velocity += settings.time_step * w.gravity;
  w.spin = w.predicted_spin;
}

}  // namespace

void solve_motion(const std::vector<Body>& bodies, const ContactSettings& settings, MotionWork& work) {
  std::vector<char> all(bodies.size(), 1);
  solve_islands(bodies, settings, all, work);
}

void solve_islands(const std::vector<Body>& bodies, const ContactSettings& settings,
                   std::vector<char>& is_dirty, MotionWork& work) {
  std::vector<std::size_t> due;
  for (std::size_t i = 0; i < work.islands.size(); ++i) {
    const auto& members = work.islands[i].bodies;
    if (std::none_of(members.begin(), members.end(), [&](int b) { return is_dirty[at(b)] != 0; })) continue;
    due.push_back(i);
    for (const int b : members) is_dirty[at(b)] = 1;
  }
  const auto solve = [&](std::size_t number) {
    const Island& island = work.islands[number];
    solve_island(settings, island, work);
    for (const int b : island.bodies) end_in_contact(work.bodies[at(b)]);
  };
  if (work.has_scripted) {
    const auto rides = [&](std::size_t number) {
      const auto& contacts = work.islands[number].contacts;
      const auto rides_one = [&](int a, int b) {
        return !work.bodies[at(a)].rides.empty() || !work.bodies[at(b)].rides.empty();
      };
      const auto& joints = work.islands[number].joints;
      return std::any_of(contacts.begin(), contacts.end(),
                         [&](int c) { return rides_one(work.contacts[at(c)].a, work.contacts[at(c)].b); }) ||
             std::any_of(joints.begin(), joints.end(),
                         [&](int k) { return rides_one(work.joints[at(k)].a, work.joints[at(k)].b); });
    };
    const auto riders =
        std::stable_partition(due.begin(), due.end(), [&](std::size_t i) { return !rides(i); });
    std::for_each(riders, due.end(), solve);
    due.erase(riders, due.end());
  }
  core::parallel_for(due.size(), 1, [&](std::size_t k) { solve(due[k]); });
  // Who has no contact goes freely again, though he was opened from another before.
  std::vector<char> is_in_island(work.bodies.size(), 0);
  for (const Island& island : work.islands)
    for (const int b : island.bodies) is_in_island[at(b)] = 1;
  core::parallel_for(work.bodies.size(), 16, [&](std::size_t i) {
    if (is_dirty[i] && work.bodies[i].is_active && !is_in_island[i])
      end_freely(bodies[i].is_dynamic(), settings, work.bodies[i]);
  });
}

void finish_motion(std::vector<Body>& bodies, ContactState& state, MotionWork& work, body::ImpulseLog& log,
                   ContactReport& report) {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const WorkBody& w = work.bodies[i];
    if (!w.is_active) continue;
    bodies[i].pose = w.end;
    state.bodies[i].last_pose = w.end;
    state.bodies[i].travelled += travelled_at_most(w, w.end);
    if (w.is_scripted) end_scripted(w, bodies[i]);
    if (bodies[i].script.strikes) end_blow(w, bodies[i]);
    if (!bodies[i].is_dynamic()) continue;
    bodies[i].velocity = w.velocity;
    bodies[i].angular_velocity = w.spin;
  }
  log_contacts(bodies, work, log);
  log_joints(work, log);
  remember_contacts(work, state);
  remember_joints(work, state);
  report.torn = find_torn(work);
  report_contacts(work, state, report);
}

namespace {

void begin_taking(const ContactSettings& settings, const StepPart& part, SearchShelf& shelf) {
  shelf.keeps_part = part.may_return && settings.has_caches;
  shelf.former = part.is_again && shelf.keeps_part ? std::move(shelf.part) : PartMemory();
  shelf.part = PartMemory();
}

// Where bodies were within the step: at the ends of the parts, and of the straight pieces of a turn; and
// where those were that were set aside at the part's begin.
std::vector<body::Way> find_ways(const MotionWork& work, const StepPart& part,
                                 const std::vector<body::BodyId>& moved) {
  std::vector<body::Way> ways;
  for (std::size_t i = 0; i < work.bodies.size(); ++i) {
    const WorkBody& w = work.bodies[i];
    if (!w.is_active) continue;
    body::Way way;
    way.id = work.ids[i];
    const int pieces = w.straight_parts, last = part.number + 1 < part.count ? pieces : pieces - 1;
    // Who was woken, or born of what is held, in the midst of the step stood still until then.
    if (part.number > 0) way.points.push_back({static_cast<double>(part.number) / part.count, w.start});
    if (std::find(moved.begin(), moved.end(), way.id) != moved.end())
      way.points.push_back({(part.number + kAsideTime) / part.count, w.start});
    for (int k = 1; k <= last; ++k) {
      const double time = (part.number + static_cast<double>(k) / pieces) / part.count;
      way.points.push_back({time, pose_on_way(w, static_cast<double>(k) / pieces)});
    }
    if (!way.points.empty()) ways.push_back(std::move(way));
  }
  return ways;
}

// Of a step in which pieces part, or many spin and collide.
int lively_parts(const ContactSettings& settings) {
  return std::max(kLeastParts, static_cast<int>(std::ceil(settings.time_step / kPartTime - 1e-9)));
}

// In how many times as many parts a step may go on at most.
int finer_parts(const ContactSettings& settings, const StepPart& part) {
  return std::min(kFiner, (lively_parts(settings) + part.count - 1) / part.count);
}

// How many times as many substeps it takes to follow links that swing so fast, rad/s.
int finer_substeps(double substep, double swing) {
  const double turn = swing * substep;
  return turn > kSwingTurn ? static_cast<int>(std::ceil(std::min(turn / kSwingTurn, kMostFiner))) : 1;
}

void count_near(const ContactSettings& settings, const ContactState& state, const MotionWork& work,
                ContactReport& report) {
  const auto turn_of = [&](const WorkBody& w) {
    return w.shape->kind != body::ShapeKind::sphere ? w.spin.norm() * settings.time_step : 0.0;
  };
  std::vector<char> is_near(work.bodies.size(), 0);
  for (const WorkPair& pair : work.pairs)
    if (!pair.is_apart) is_near[at(pair.a)] = is_near[at(pair.b)] = 1;
  for (const WorkPair& pair : work.pairs) {
    if (state.pairs[at(pair.state)].trouble_age > 0) continue;  // not hit in this part
    const double turn = std::max(turn_of(work.bodies[at(pair.a)]), turn_of(work.bodies[at(pair.b)]));
    report.turning_hits += turn > kStraightTurn ? 1 : 0;
  }
  std::vector<double> turns;
  for (std::size_t i = 0; i < work.bodies.size(); ++i) {
    const WorkBody& w = work.bodies[i];
    if (!is_near[i] || !w.is_active || w.inverse_mass == 0.0) continue;
    ++report.near_bodies;
    if (w.shape->kind != body::ShapeKind::sphere) turns.push_back(turn_of(w));
  }
  const std::size_t few = at(report.near_bodies / kManySpin);
  if (few >= turns.size()) return;
  const auto place = turns.begin() + static_cast<std::ptrdiff_t>(few);
  std::nth_element(turns.begin(), place, turns.end(), std::greater<>());
  report.crowd_turn = *place;
}

// Who was cut stood still for the whole part: short parts cost less of the motion.
bool were_many_cut(const ContactSettings& settings, const ContactReport& report) {
  return kManyCut * report.newly_cut > report.near_bodies && settings.time_step > kPartTime;
}

// So that what turns so far in the step, rad, turns little in each.
int count_turn_parts(const ContactSettings& settings, double turn) {
  const int most = lively_parts(settings);
  int parts = 1;
  while (parts < most && turn > kStraightTurn * parts) parts *= 2;
  return std::min(parts, most);
}

// What is hit on its way did not see it coming: over shorter ways more does.
int find_next_parts(const ContactSettings& settings, const ContactReport& report, int parts, double swing) {
  const bool are_many_hit = kManyHits * report.turning_hits > report.near_bodies;
  const int spin_parts = are_many_hit ? count_turn_parts(settings, report.crowd_turn) : 1;
  // What is opened in position tears chains.
  const int swing_parts = report.torn > kTorn ? count_turn_parts(settings, swing * settings.time_step) : 1;
  const int most = lively_parts(settings);
  const int finer_parts = were_many_cut(settings, report) ? std::min(most, kFiner * parts) : 1;
  return std::max({spin_parts, swing_parts, finer_parts});
}

}  // namespace

int count_parts(const std::vector<Body>& bodies, const ContactSettings& settings, const ContactState& state) {
  std::size_t newborn = 0;
  for (const Body& b : bodies) {
    if (!b.is_dynamic() || !body::is_mesh(b.shape->kind)) continue;
    const auto known = std::lower_bound(state.bodies.begin(), state.bodies.end(), b.id,
                                        [](const BodyState& s, body::BodyId id) { return s.id < id; });
    const bool is_known = known != state.bodies.end() && known->id == b.id;
    // In the very first step all are unknown; pieces are those of another body.
    newborn += !is_known && (!state.bodies.empty() || (b.family != 0 && b.id != b.family)) ? 1 : 0;
  }
  return newborn >= 2 ? std::max(lively_parts(settings), state.next_parts) : state.next_parts;
}

bool may_be_tried(const ContactSettings& settings, const StepPart& part) {
  return finer_parts(settings, part) < 2;
}

StepPart divide_to(const ContactSettings& settings, const StepPart& part, double longest) {
  const int wanted = static_cast<int>(std::ceil(std::min(settings.time_step / longest, kMostParts)));
  const int finer = (std::max(wanted, part.count) + part.count - 1) / part.count;
  return {part.number * finer, part.count * finer};
}

std::optional<StepPart> divide_where_cut(const ContactSettings& settings, const StepPart& part,
                                         const ContactReport& moved) {
  const int finer = finer_parts(settings, part);
  if (finer < 2 || !were_many_cut(settings, moved)) return std::nullopt;
  return StepPart{part.number * finer, part.count * finer};
}

namespace {

// Who may meet whom, when all are awake whom the awake come upon, and whom that could move: few rounds.
void find_awake_pairs(std::vector<Body>& bodies, const ContactSettings& settings, ContactState& state,
                      MotionWork& work) {
  find_candidate_pairs(bodies, settings, state, work);
  while (!work.to_wake.empty()) {
    wake_struck(bodies, settings, state, work.to_wake);
    find_candidate_pairs(bodies, settings, state, work);
  }
}

// Per body; empty: nobody does.
std::vector<char> find_sleepers(const std::vector<Body>& bodies) {
  std::vector<char> sleeps;
  if (std::none_of(bodies.begin(), bodies.end(), [](const Body& b) { return b.sleeps(); })) return sleeps;
  for (const Body& b : bodies) sleeps.push_back(b.sleeps() ? 1 : 0);
  return sleeps;
}

}  // namespace

ContactReport move_part(std::vector<Body>& bodies, const ContactSettings& settings, const StepPart& part,
                        ContactState& state, body::ImpulseLog& log) {
  ContactSettings own = settings;
  own.time_step /= part.count;
  own.substeps = std::max(1, settings.substeps / part.count);
  const int usual_substeps = own.substeps;
  const double usual_substep = own.time_step / usual_substeps;
  own.substeps *= finer_substeps(usual_substep, state.swing);
  begin_taking(own, part, *state.shelf);
  aim_scripted(bodies, own.time_step);
  const std::vector<char> slept = find_sleepers(bodies);
  wake_bodies(bodies, own, state);
  ContactReport report;
  std::vector<body::BodyId> moved;
  MotionWork work;
  find_awake_pairs(bodies, own, state, work);
  // As many rounds as bodies lie in one place, at most.
  for (std::size_t round = 0; round < bodies.size(); ++round) {
    if (!part_coincident(bodies, own, state, work, report.parted, moved)) break;
    find_candidate_pairs(bodies, own, state, work);
  }
  // What joints bore in the step before says nothing of a blow.
  const double swing_by_blows = find_swing_by_blows(bodies, work, own.time_step);
  const int substeps_for_blows = usual_substeps * finer_substeps(usual_substep, swing_by_blows);
  if (substeps_for_blows > own.substeps) {
    own.substeps = substeps_for_blows;
    find_awake_pairs(bodies, own, state, work);
  }
  // Each round wakes somebody, or lets him strike.
  for (;;) {
    if (part.may_return)
      put_on_shelf(work, state);
    else
      state.shelf->pairs.clear();
    work.is_trial = part.is_trial;
    work.is_shortest = settings.time_step <= kPartTime || finer_parts(settings, part) < 2;
    solve_motion(bodies, own, work);
    ContactReport guarded = report;
    guard_motion(bodies, own, slept, state, work, guarded);
    if (work.to_wake.empty() && work.to_strike.empty()) {
      report = std::move(guarded);
      break;
    }
    wake_struck(bodies, own, state, work.to_wake);
    for (const body::BodyId id : work.to_strike) begin_strike(*body::find_body(bodies, id));
    find_awake_pairs(bodies, own, state, work);
  }
  const std::size_t first = log.size();
  finish_motion(bodies, state, work, log, report);
  count_near(settings, state, work, report);
  for (std::size_t i = first; i < log.size(); ++i) log[i].time += part.number * own.time_step;
  if (own.has_ways) report.ways = find_ways(work, part, moved);
  if (state.shelf->keeps_part) end_part(work, state.shelf->part);
  free_pairs(work);
  keep_scratch(work, state);
  return report;
}

void add_part(const StepPart& part, ContactReport&& moved, ContactReport& step) {
  step.contacts = moved.contacts;
  step.solver_contacts = std::max(step.solver_contacts, moved.solver_contacts);
  step.least_gap = std::min(step.least_gap, moved.least_gap);
  step.hits += moved.hits;
  step.turning_hits += moved.turning_hits;
  step.rounds += moved.rounds;
  step.ways_tested += moved.ways_tested;
  step.test_bytes = std::max(step.test_bytes, moved.test_bytes);
  step.failsafe_steps += moved.failsafe_steps;
  step.newly_cut += moved.newly_cut;
  if (moved.longest_cut > step.longest_cut) {
    step.longest_cut = moved.longest_cut;
    step.longest_cut_pair = moved.longest_cut_pair;
  }
  step.crossing_pairs = moved.crossing_pairs;
  step.new_crossing_pairs.insert(step.new_crossing_pairs.end(), moved.new_crossing_pairs.begin(),
                                 moved.new_crossing_pairs.end());
  step.parted.insert(step.parted.end(), moved.parted.begin(), moved.parted.end());
  step.frozen_share += moved.frozen_share / part.count;
  for (body::Way& way : moved.ways) {
    const auto place =
        std::lower_bound(step.ways.begin(), step.ways.end(), way.id,
                         [](const body::Way& known, body::BodyId id) { return known.id < id; });
    if (place == step.ways.end() || place->id != way.id) {
      step.ways.insert(place, std::move(way));
    } else {
      auto first = way.points.begin();  // the last part ended where this one begins
      if (first != way.points.end() && first->time <= place->points.back().time) ++first;
      place->points.insert(place->points.end(), first, way.points.end());
    }
  }
  step.residual = std::max(step.residual, moved.residual);
  step.torn = std::max(step.torn, moved.torn);
  step.drift = std::max(step.drift, moved.drift);
  step.awake_bodies = moved.awake_bodies;
  step.near_bodies = moved.near_bodies;
  step.crowd_turn = moved.crowd_turn;
}

void end_step(const ContactSettings& settings, const ContactReport& step, int parts, ContactState& state) {
  state.next_parts = find_next_parts(settings, step, parts, state.swing);
}

ContactReport step_motion(std::vector<Body>& bodies, const ContactSettings& settings, ContactState& state,
                          body::ImpulseLog& log) {
  ContactReport step;
  StepPart part{0, count_parts(bodies, settings, state)};
  for (; part.number < part.count; ++part.number) {
    add_part(part, move_part(bodies, settings, part, state, log), step);
    end_strikes(bodies);
  }
  end_step(settings, step, part.count, state);
  return step;
}

}  // namespace shatterbox::dynamics
