// Stage: from bodies to pairs, contacts and islands.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <utility>

#include "engine/collision/analytic_contact.h"
#include "engine/core/index.h"
#include "engine/core/parallel.h"
#include "engine/dynamics/contact_graph.h"
#include "engine/dynamics/earlier_round.h"
#include "engine/dynamics/joint_work.h"
#include "engine/dynamics/motion_work.h"
#include "engine/dynamics/pair_contacts.h"
#include "engine/dynamics/pair_search.h"
#include "engine/dynamics/rest.h"
#include "engine/dynamics/scripted_motion.h"
#include "engine/dynamics/step_motion.h"

namespace shatterbox::dynamics {
namespace {

using body::Body;
using body::ShapeKind;
using collision::Contact;
using core::at;

constexpr double kOfTouch = 0.01;  // share of its momentum with which what only touches wakes further ones

// Colliders and inertia of bodies that the state does not know: from a copy of the same shape, from the
// shelf, or made now, one for all copies.
void find_colliders(ContactState& state, const std::vector<std::size_t>& unknown) {
  if (unknown.empty()) return;
  std::map<const body::Shape*, const BodyState*> known;
  for (const auto* list : {&state.shelf->bodies, &state.bodies, &state.shelf->newborn}) {
    for (const BodyState& s : *list) {
      if (s.collider) known.emplace(s.shape.get(), &s);
    }
  }
  std::vector<std::size_t> to_make;
  for (const std::size_t i : unknown) {
    BodyState& fresh = state.bodies[i];
    const auto [twin, is_first] = known.emplace(fresh.shape.get(), &fresh);
    if (is_first) to_make.push_back(i);
  }
  core::parallel_for(to_make.size(), 1, [&](std::size_t k) { know_shape(state.bodies[to_make[k]]); });
  for (const std::size_t i : unknown) {
    BodyState& fresh = state.bodies[i];
    const BodyState& twin = *known.at(fresh.shape.get());
    fresh.collider = twin.collider;
    fresh.inertia = twin.inertia;
  }
}

void match_bodies(const std::vector<Body>& bodies, ContactState& state, MotionWork& work) {
  std::vector<BodyState> matched;
  std::vector<std::size_t> unknown;
  matched.reserve(bodies.size());
  std::size_t old = 0;
  for (const Body& b : bodies) {
    while (old < state.bodies.size() && state.bodies[old].id < b.id) ++old;
    if (old < state.bodies.size() && state.bodies[old].id == b.id && state.bodies[old].shape == b.shape) {
      matched.push_back(state.bodies[old]);
      work.is_new.push_back(!is_same_pose(matched.back().last_pose, b.pose));
      continue;
    }
    work.is_new.push_back(1);
    unknown.push_back(matched.size());
    matched.push_back({b.id, b.shape, nullptr, {}, b.pose, b.pose});
  }
  state.bodies = std::move(matched);
  find_colliders(state, unknown);
  state.shelf->bodies = state.bodies;
  state.shelf->newborn.clear();
}

// Per body: whether something bore it, or was borne by it, in the part before. Of no use where all sleep.
std::vector<char> find_borne(const std::vector<Body>& bodies, const ContactState& state) {
  std::vector<char> is_borne(bodies.size(), 0);
  if (std::none_of(bodies.begin(), bodies.end(), [](const Body& b) { return b.is_dynamic() && b.is_awake; }))
    return is_borne;
  const auto note = [&](body::BodyId id) {
    const Body* body = body::find_body(bodies, id);
    if (body != nullptr) is_borne[static_cast<std::size_t>(body - bodies.data())] = 1;
  };
  for (const PairState& pair : state.pairs) {
    if (!pair.was_loaded()) continue;
    note(pair.body_a);
    note(pair.body_b);
  }
  return is_borne;
}

WorkBody make_work_body(const Body& b, const BodyState& memory, bool is_borne,
                        const ContactSettings& settings) {
  WorkBody w;
  w.shape = b.shape.get();
  w.collider = memory.collider.get();
  w.inertia = memory.inertia;
  w.reach = w.collider->bounding_radius;
  w.travelled = memory.travelled;
  w.start = w.end = w.predicted = b.pose;
  w.rotation = b.pose.rotation;
  const double dt = settings.time_step;
  w.placed.collider = w.collider;
  w.may_break = b.may_break;
  w.is_quiet = is_quiet(settings, b.velocity, b.angular_velocity, w.reach);
  if (b.motion == body::Motion::scripted && !b.script.strikes) {
    w.is_scripted = true;
    w.velocity = b.velocity;
    w.spin = b.angular_velocity;
    w.is_active = b.is_driven();
    w.turn_angle = dt * w.spin.norm();
    w.predicted.translation += dt * w.velocity;
    w.predicted.rotation = (rotation_by(dt * w.spin) * w.start.rotation).normalized();
    if (w.is_active) plan_rides(b, dt, settings.substeps, w);
  } else if (b.is_dynamic() && b.is_awake) {
    w.is_active = true;
    w.inverse_mass = b.inverse_mass;
    w.locked = b.locked;
    w.velocity = b.velocity;
    w.spin = b.angular_velocity;
    w.velocity_start = w.velocity;
    w.spin_start = w.spin;
    w.gravity = b.free_acceleration(settings.gravity);
    w.torque = b.torque;
    if (b.inverse_inertia.cwiseAbs().maxCoeff() > 0.0 && b.locked.count_turns() > 0)
      w.inverse_moments = w.inertia.moments.cwiseInverse();
    w.inverse_inertia = inverse_inertia_at(w, w.rotation);
    const Vec3 fall = (0.5 * dt * dt) * w.gravity;
    if (is_borne) w.fall_left_out = fall;
    w.predicted.translation += dt * w.velocity + (fall - w.fall_left_out);
    Vec3 spin = w.spin;
    advance_turning(w, dt, w.predicted.rotation, spin);
    w.predicted_spin = spin;
    w.turn_angle = free_turn_angle(w, dt);
  }
  return w;
}

// Bodies write where they wrote in the part before.
void lend_scratch(std::vector<BodyScratch>& scratch, MotionWork& work) {
  std::size_t i = 0;
  for (BodyScratch& own : scratch) {
    while (i < work.ids.size() && work.ids[i] < own.id) ++i;
    if (i == work.ids.size()) break;
    WorkBody& w = work.bodies[i];
    if (work.ids[i] != own.id || own.placed.collider != w.collider) continue;
    own.clear();
    w.placed = std::move(own.placed);
    w.predicted_vertices = std::move(own.predicted_vertices);
    w.end_vertices = std::move(own.end_vertices);
  }
  scratch.clear();
}

// A step that is taken again looks at pairs that stand where they stood.
void take_from_shelf(ContactState& state, MotionWork& work) {
  const auto& rows = state.shelf->pairs;
  std::size_t row = 0;
  for (const WorkPair& pair : work.pairs) {
    PairState& memory = state.pairs[at(pair.state)];
    const std::pair key(memory.body_a, memory.body_b);
    while (row < rows.size() && std::pair(rows[row].body_a, rows[row].body_b) < key) ++row;
    if (row == rows.size() || memory.gaps || std::pair(rows[row].body_a, rows[row].body_b) != key) continue;
    const auto& kept = rows[row].gaps;
    if (is_same_pose(kept->start_a, work.bodies[at(pair.a)].start) &&
        is_same_pose(kept->start_b, work.bodies[at(pair.b)].start))
      memory.gaps = kept;
  }
}

// The memory of pairs: of those found, of those of two bodies that both do not move (asleep), and of no
// others.
void match_pairs(const std::vector<Body>& bodies, const std::vector<FoundPair>& found, MotionWork& work,
                 ContactState& state) {
  std::vector<PairState> matched;
  matched.reserve(found.size());
  work.pairs.reserve(found.size());
  const auto is_still = [&](body::BodyId id) {
    const auto place = std::lower_bound(work.ids.begin(), work.ids.end(), id);
    return place != work.ids.end() && *place == id &&
           !work.bodies[static_cast<std::size_t>(place - work.ids.begin())].is_active;
  };
  std::size_t old = 0;
  const auto keep_still = [&](const PairState& pair) {
    if (is_still(pair.body_a) && is_still(pair.body_b)) matched.push_back(pair);
  };
  for (const auto& pair : found) {
    const std::pair key(bodies[at(pair.a)].id, bodies[at(pair.b)].id);
    while (old < state.pairs.size() && std::pair(state.pairs[old].body_a, state.pairs[old].body_b) < key) {
      keep_still(state.pairs[old++]);
    }
    WorkPair w;
    w.a = pair.a;
    w.b = pair.b;
    w.clearance = pair.clearance;
    w.state = static_cast<int>(matched.size());
    if (old < state.pairs.size() && std::pair(state.pairs[old].body_a, state.pairs[old].body_b) == key) {
      matched.push_back(std::move(state.pairs[old++]));
      w.is_first_seen = work.is_new[at(pair.a)] || work.is_new[at(pair.b)];
      if (w.is_first_seen) matched.back().forget_caches();
    } else {
      w.is_first_seen = true;
      matched.emplace_back();
      matched.back().body_a = key.first;
      matched.back().body_b = key.second;
    }
    work.pairs.push_back(std::move(w));
  }
  while (old < state.pairs.size()) keep_still(state.pairs[old++]);
  state.pairs = std::move(matched);
  take_from_shelf(state, work);
}

// What kind of pair this is and how far it must be looked at.
void classify(const std::vector<Body>& bodies, const ContactSettings& settings, const PairState& memory,
              const MotionWork& work, WorkPair& pair) {
  const WorkBody &a = work.bodies[at(pair.a)], &b = work.bodies[at(pair.b)];
  const bool a_is_measure =
      bodies[at(pair.a)].is_dynamic() && (!bodies[at(pair.b)].is_dynamic() || a.reach <= b.reach);
  pair.material = pair_material(bodies[at(pair.a)], bodies[at(pair.b)], settings);
  pair.size = 2.0 * (a_is_measure ? a.reach : b.reach);
  pair.motion = motion_bound(a, a.predicted, b, b.predicted);
  // One may be held while the other falls.
  const double pull = std::max({settings.gravity.norm(), a.gravity.norm(), b.gravity.norm()});
  // Who is borne may fall after all.
  const double motion = pair.motion + (a.fall_left_out - b.fall_left_out).norm();
  const double felt = motion + pull * settings.time_step * settings.time_step;
  pair.rounding = 1e-14 * (pair.size + a.start.translation.cwiseAbs().maxCoeff() +
                           b.start.translation.cwiseAbs().maxCoeff());
  const double usual_gap = settings.kept_gap * pair.size;
  pair.is_plane = a.shape->kind == ShapeKind::plane || b.shape->kind == ShapeKind::plane;
  pair.is_flipped = a.shape->kind == ShapeKind::plane;
  pair.is_analytic = collision::is_analytic_pair(a.shape->kind, b.shape->kind);
  pair.has_sides =
      pair.is_plane || pair.is_analytic || body::is_round(a.shape->kind) || body::is_round(b.shape->kind);
  // Surfaces that do not break for it are found on the way soon enough.
  const bool foresees_falls = pair.is_analytic || a.may_break || b.may_break;
  const double foreseen = std::min(foresees_falls ? felt : motion, settings.speculative_margin * pair.size);
  pair.margin = 2.0 * usual_gap + (pair.is_plane ? felt : foreseen);
  if (settings.has_caches && !pair.is_plane && !pair.is_analytic && !turns_far(a) && !turns_far(b)) {
    pair.clear = memory.clear - (a.travelled + b.travelled - memory.clear_since);
    pair.clearance = std::max(pair.clearance, pair.clear - pair.motion);
  }
  pair.is_apart = pair.clearance > pair.margin;
  if (pair.is_plane || pair.is_analytic) {
    pair.motion = felt;
    return;
  }
  const double slack = settings.search_slack * pair.size;
  pair.looks_ahead = pair.motion > slack;
  // Which features may meet is told by how bodies move where they are near each other.
  if (pair.motion + usual_gap > pair.margin && !pair.is_apart && !turns_far(a) && !turns_far(b))
    pair.motion = approach_bound(a, a.predicted, b, b.predicted, pair.motion + usual_gap);
  pair.is_fast = pair.motion > slack;
  const double needed = std::max(pair.margin, pair.motion + usual_gap);
  if (pair.is_fast || pair.is_apart) return;
  if (settings.has_caches && memory.gaps)
    pair.beyond = memory.gaps->search->margin - moved_since(*memory.gaps->search, a, b, needed);
  pair.needs_search = pair.beyond < needed;
}

// Sleepers that something hits, with its momentum, or touches and could move.
void find_sleepers_to_wake(const std::vector<Body>& bodies, const ContactSettings& settings,
                           MotionWork& work) {
  for (const WorkPair& pair : work.pairs) {
    const Body &a = bodies[at(pair.a)], &b = bodies[at(pair.b)];
    const bool a_sleeps = a.sleeps(), b_sleeps = b.sleeps();
    if (a_sleeps == b_sleeps || pair.contacts.empty()) continue;
    const int mover = a_sleeps ? pair.b : pair.a;
    const WorkBody& w = work.bodies[at(mover)];
    if (!w.is_active || (!w.is_scripted && is_quiet(settings, w.velocity, w.spin, w.reach))) continue;
    const bool is_strong = could_move(settings, a_sleeps ? b : a, a_sleeps ? a : b);
    for (const Contact& c : pair.contacts) {
      const double closing = closing_on_sleeper(w, c, a_sleeps);
      if (c.gap > 2.0 * pair.kept_gap + std::max(0.0, closing * settings.time_step)) continue;
      const bool is_hit = closing > pair.threshold;
      if (!is_hit && !is_strong) continue;
      const double speed = greatest_speed(w.velocity, w.spin, w.reach);
      const double momentum =
          w.inverse_mass > 0.0 ? speed / w.inverse_mass : std::numeric_limits<double>::infinity();
      work.to_wake.push_back({a_sleeps ? a.id : b.id, is_hit ? momentum : kOfTouch * momentum});
      break;
    }
  }
}

// Gives these pairs rows among the others, where they have none; the known pairs keep theirs.
void make_room(std::vector<WorkPair>& missed, const std::vector<body::BodyId>& ids, ContactState& state,
               std::vector<WorkPair>& known) {
  std::vector<PairState> rows;
  rows.reserve(state.pairs.size() + missed.size());
  std::vector<int> moved_to;
  moved_to.reserve(state.pairs.size());
  const auto take_until = [&](const std::pair<body::BodyId, body::BodyId>& key) {
    for (std::size_t k = moved_to.size(); k < state.pairs.size(); ++k) {
      PairState& row = state.pairs[k];
      if (std::pair(row.body_a, row.body_b) >= key) break;
      moved_to.push_back(static_cast<int>(rows.size()));
      rows.push_back(std::move(row));
    }
  };
  for (WorkPair& pair : missed) {
    const std::pair key(ids[at(pair.a)], ids[at(pair.b)]);
    take_until(key);
    pair.state = static_cast<int>(rows.size());
    const std::size_t next = moved_to.size();
    const bool has_row = next < state.pairs.size() && state.pairs[next].body_a == key.first &&
                         state.pairs[next].body_b == key.second;
    if (has_row) continue;
    rows.emplace_back();
    rows.back().body_a = key.first;
    rows.back().body_b = key.second;
    rows.back().kept_gap = pair.kept_gap;
  }
  take_until({std::numeric_limits<body::BodyId>::max(), std::numeric_limits<body::BodyId>::max()});
  for (WorkPair& pair : known) pair.state = moved_to[at(pair.state)];
  state.pairs = std::move(rows);
}

// Pairs that were not thought of, ascending: without contacts, only to be kept from crossing.
void add_pairs(const std::vector<Body>& bodies, const ContactSettings& settings,
               const std::vector<FoundPair>& found, ContactState& state, MotionWork& work) {
  std::vector<WorkPair> missed;
  for (const FoundPair& next : found) {
    WorkPair& pair = missed.emplace_back();
    pair.a = next.a;
    pair.b = next.b;
    classify(bodies, settings, {}, work, pair);
    pair.kept_gap = settings.kept_gap * pair.size;
    pair.threshold = impact_threshold(settings, pair.kept_gap);
    pair.is_apart = pair.is_free_certified = false;
    if (!pair.is_analytic) continue;
    const WorkBody &a = work.bodies[at(pair.a)], &b = work.bodies[at(pair.b)];
    Vec3 normal;
    pair.least_gap = collision::analytic_gap(*a.shape, a.start, *b.shape, b.start, normal);
  }
  make_room(missed, work.ids, state, work.pairs);
  work.pairs.insert(work.pairs.end(), std::make_move_iterator(missed.begin()),
                    std::make_move_iterator(missed.end()));
}

}  // namespace

void find_candidate_pairs(const std::vector<Body>& bodies, const ContactSettings& settings,
                          ContactState& state, MotionWork& work) {
  keep_scratch(work, state);
  MotionWork earlier = std::move(work);
  work = MotionWork();
  work.substep = settings.time_step / settings.substeps;
  work.warm_scale = state.substep > 0.0 ? work.substep / state.substep : 1.0;
  match_bodies(bodies, state, work);
  bool anything_moves = false;
  const std::vector<char> is_borne = find_borne(bodies, state);
  work.bodies.resize(bodies.size());
  core::parallel_for(bodies.size(), 32, [&](std::size_t i) {
    work.bodies[i] = make_work_body(bodies[i], state.bodies[i], is_borne[i] != 0, settings);
  });
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    work.ids.push_back(bodies[i].id);
    anything_moves = anything_moves || work.bodies[i].is_active;
    work.has_scripted = work.has_scripted || !work.bodies[i].rides.empty();
  }
  if (!anything_moves) return;
  lend_scratch(state.shelf->scratch, work);
  list_joints(state, work);
  std::vector<char> is_active(bodies.size());
  core::parallel_for(bodies.size(), 32, [&](std::size_t i) {
    WorkBody& w = work.bodies[i];
    look_about(settings, w.predicted, w);
    is_active[i] = w.is_active ? 1 : 0;
  });
  match_pairs(bodies, find_pairs(bodies, work, is_active), work, state);

  struct Needs {
    bool place = false, boxes = false, predicted = false;
  };
  std::vector<Needs> needs(bodies.size());
  core::parallel_for(work.pairs.size(), 64, [&](std::size_t p) {
    classify(bodies, settings, state.pairs[at(work.pairs[p].state)], work, work.pairs[p]);
  });
  match_earlier(earlier, state.pairs, work);
  const auto is_taken_over = [&](const WorkPair& pair) { return pair.earlier >= 0 && settings.has_caches; };
  SearchShelf& shelf = *state.shelf;
  if (shelf.keeps_part) begin_part(settings.time_step, state.pairs, shelf.former, work, shelf.part);
  for (const WorkPair& pair : work.pairs) {
    if (pair.is_apart || is_taken_over(pair) || pair.former >= 0) continue;
    for (const int i : {pair.a, pair.b}) {
      Needs& n = needs[at(i)];
      n.place = true;
      n.boxes = n.boxes || pair.needs_search || pair.is_fast || (pair.is_first_seen && !pair.is_analytic) ||
                state.pairs[at(pair.state)].is_exempt;
      n.predicted = n.predicted || pair.looks_ahead;
    }
  }
  core::parallel_for(bodies.size(), 8, [&](std::size_t i) {
    WorkBody& w = work.bodies[i];
    if (w.shape->kind == ShapeKind::plane) return;
    if (needs[i].place) place(w);
    if (needs[i].boxes) place_in_boxes(w);
    if (needs[i].predicted) place_at(w, w.predicted, w.predicted_vertices);
  });
  core::parallel_for(work.pairs.size(), 4, [&](std::size_t p) {
    WorkPair& pair = work.pairs[p];
    PairState& memory = state.pairs[at(pair.state)];
    if (is_taken_over(pair))
      take_over(earlier.pairs[at(pair.earlier)], pair);
    else if (pair.former >= 0)
      meet_again(settings, shelf.former.pairs[at(pair.former)], work, memory, pair);
    else
      find_pair_contacts(settings, work, memory, pair);
  });
  if (shelf.keeps_part) keep_meetings(state.pairs, work, shelf.part);
  free_pairs(earlier);
  forget_joined_contacts(work);
  find_sleepers_to_wake(bodies, settings, work);
  build_contact_graph(state, work);
}

void keep_scratch(MotionWork& work, ContactState& state) {
  if (work.bodies.empty()) return;
  std::vector<BodyScratch>& scratch = state.shelf->scratch;
  scratch.clear();
  for (std::size_t i = 0; i < work.bodies.size(); ++i) {
    WorkBody& w = work.bodies[i];
    if (!w.is_placed) continue;
    scratch.push_back(
        {work.ids[i], std::move(w.placed), std::move(w.predicted_vertices), std::move(w.end_vertices)});
  }
}

void put_on_shelf(const MotionWork& work, ContactState& state) {
  auto& rows = state.shelf->pairs;
  rows.clear();
  for (const WorkPair& pair : work.pairs) {
    const PairState& memory = state.pairs[at(pair.state)];
    if (memory.gaps) rows.push_back({memory.body_a, memory.body_b, memory.gaps});
  }
}

void find_missed_pairs(const std::vector<Body>& bodies, const ContactSettings& settings, ContactState& state,
                       MotionWork& work) {
  std::vector<char> has_strayed(bodies.size(), 0);
  bool anyone = false;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    WorkBody& w = work.bodies[i];
    if (!w.is_active || goes_as_predicted(w) || w.shape->kind == ShapeKind::plane) continue;
    if (is_within_looked(settings, w)) continue;
    has_strayed[i] = 1;
    anyone = true;
    look_about(settings, w.end, w);
  }
  if (!anyone) return;
  std::vector<FoundPair> missed = find_pairs(bodies, work, has_strayed);
  std::erase_if(missed, [&](const FoundPair& pair) { return work.has_pair(pair.a, pair.b); });
  if (missed.empty()) return;
  for (const FoundPair& pair : missed) work.missed_pairs.emplace_back(pair.a, pair.b);
  std::sort(work.missed_pairs.begin(), work.missed_pairs.end());
  add_pairs(bodies, settings, missed, state, work);
}

}  // namespace shatterbox::dynamics
