// Stage: the continuous pass over the straight paths of all vertices from the old to the new rigid pose. What
// would meet on the way first becomes a contact of the solver, which is run again; then hits are opened again
// in position and the paths tested anew; at last bodies go as one, or not all the way. [BFA02], [BHTF07] sec.
// III; departs from both because the tests are by separating directions with a least separation, which has no
// false negatives.
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "engine/core/buckets.h"
#include "engine/core/index.h"
#include "engine/core/parallel.h"
#include "engine/core/stop.h"
#include "engine/dynamics/contact_graph.h"
#include "engine/dynamics/contact_solver.h"
#include "engine/dynamics/impact_zones.h"
#include "engine/dynamics/motion_work.h"
#include "engine/dynamics/opening.h"
#include "engine/dynamics/path_test.h"
#include "engine/dynamics/rest.h"
#include "engine/dynamics/scripted_motion.h"
#include "engine/dynamics/step_motion.h"

namespace shatterbox::dynamics {
namespace {

using collision::Contact;
using core::at;

constexpr int kLastRounds = 24;       // in which bodies only keep what they have
constexpr int kWideRounds = 4;        // the first of these ask for room all the same, if there is any
constexpr int kLastPatience = 4;      // of these, without fewer hits
constexpr std::size_t kFewHits = 20;  // but of no more than so many
constexpr double kDeep =
    1.0;  // share of the kept gap by which a hit of surfaces must overshoot to be solved again
constexpr double kDeepInHeap = 0.1;  // the same, of the pair's size, where a heap would be solved for it
// Share of the kept gap to which hits are opened: less would be used up in the next steps.
constexpr double kOpening = 0.5, kLastOpening = 0.05;
constexpr double kElsewhere = 1e300;  // m: a way that has nothing to do with the one before
constexpr int kMostSolves = 8;        // of islands that got contacts on their ways
constexpr int kPatience = 2;          // rounds without fewer hits
constexpr double kTurned = 0.01;      // rad: a normal that lies otherwise is that of another meeting
constexpr double kWedged = 4.0;       // times what it could take to move all that is there
constexpr int kMostZoneRounds = 8;    // before whole steps are taken back
constexpr int kZoneOpenings = 12;     // after bodies were united, before more are
constexpr int kZonePatience = 4;      // of these, without fewer hits

double wanted_separation(double gap, double kept_gap) {
  const double safe = kSafe * kept_gap;
  return gap > 4.0 * safe ? std::max(2.0 * safe, 0.5 * std::min(gap, kept_gap)) : 0.96 * gap;
}

// Of rounds that go on as long as they get anywhere.
class Patience {
 public:
  // A few hits are worth any number of rounds.
  Patience(int rounds, std::size_t few) : rounds_(rounds), few_(few) {}

  // False once that many rounds had no fewer hits than one before them.
  bool lasts(std::size_t hits) {
    since_ = hits < fewest_ || hits <= few_ ? 0 : since_ + 1;
    fewest_ = std::min(fewest_, hits);
    return since_ < rounds_;
  }

 private:
  int rounds_, since_ = 0;
  std::size_t few_;
  std::size_t fewest_ = static_cast<std::size_t>(-1);
};

class Guard {
 public:
  Guard(const std::vector<body::Body>& bodies, const ContactSettings& settings,
        const std::vector<char>& slept, ContactState& state, MotionWork& work, ContactReport& report)
      : bodies_(bodies),
        settings_(settings),
        slept_(slept),
        state_(state),
        work_(work),
        report_(report),
        first_contacts_(work.contacts.size()),
        former_(state.shelf->former),
        memory_(state.shelf->part),
        paths_(settings, work) {}

  void run() {
    was_cut_.assign(work_.bodies.size(), 0);
    add_missed_pairs();
    std::erase_if(due_, [&](std::size_t p) {
      const WorkPair& pair = work_.pairs[p];
      return pair.is_free_certified && goes_as_predicted(work_.bodies[at(pair.a)]) &&
             goes_as_predicted(work_.bodies[at(pair.b)]);
    });
    bool has_hits = test();
    // One who is hit may hit the next: that is followed where hits are taken one by one.
    const int solves = settings_.continuous_rounds > 0 ? kMostSolves : 0;
    if (wakes_sleepers() || strikes_held() || strikes_jammed()) return;
    for (int solve = 0; has_hits && solve < solves && solve_again(solve == 0); ++solve) {
      has_hits = test();
      if (wakes_sleepers() || strikes_held()) return;
    }
    report_.is_unfinished = has_hits && work_.is_trial;
    if (report_.is_unfinished) return;
    has_hits = open_in_rounds(has_hits);
    // What is pressed, and gave way in part, is struck by what comes upon it; later it is only pressed.
    if (!work_.to_wake.empty() || (has_hits && strikes_pressed())) return;
    while (has_hits && hold_up_scripted()) has_hits = open_in_rounds(test());
    if (!work_.to_wake.empty()) return;
    content_with_less();
    // Where there is no room to open, bodies keep what they have; all give way alike, for a splinter between
    // great shards cannot hold them apart by its mass. At first they are asked for a little: what came to be
    // picometres from another would have to be moved as exactly to keep that.
    const int last_rounds = settings_.continuous_rounds > 0 ? kLastRounds : 0;
    Patience patience(kLastPatience, kFewHits);
    for (int round = 0; has_hits && round < last_rounds && patience.lasts(hit_.size()); ++round) {
      ++report_.rounds;
      open(round < kWideRounds ? kLastOpening : 0.0, Yielding::alike);
      has_hits = test();
    }
    note_trouble();
    if (has_hits) zones_.emplace(work_);
    for (int round = 0; has_hits; ++round) {
      go_in_zones(round >= kMostZoneRounds);
      has_hits = test();
      if (round < kMostZoneRounds && zones_->has_wholes()) has_hits = open_zones_in_rounds(has_hits);
    }
    if (zones_) settle_zones();
    note_hooked();
    note_stuck();
    report_.test_bytes = kept_bytes();
  }

 private:
  // Bodies that end elsewhere than was thought may meet others.
  void add_missed_pairs() {
    find_missed_pairs(bodies_, settings_, state_, work_);
    for (std::size_t p = hits_.size(); p < work_.pairs.size(); ++p) make_due(p);
    hits_.resize(work_.pairs.size());
    known_.resize(work_.pairs.size());
    in_zone_.resize(work_.pairs.size(), 0);
    was_hit_.resize(work_.pairs.size(), 0);
    is_known_.resize(work_.pairs.size(), 0);
    bounces_.resize(work_.pairs.size(), 0);
    spare_.resize(work_.pairs.size(), 0.0);
  }

  // What crosses passes, unless it has a side: that may not cross deeper.
  void make_due(std::size_t p) {
    if (!work_.pairs[p].passes) due_.push_back(p);
  }

  // Tests all pairs that are due; true if any path is not free.
  bool test() {
    core::stop_if_asked();
    const std::vector<std::size_t> unknown =
        former_.pairs.empty() ? std::vector<std::size_t>{} : recall_all();
    const std::vector<std::size_t>& must_go = former_.pairs.empty() ? due_ : unknown;
    paths_.prepare(must_go);
    core::parallel_for(must_go.size(), 4, [&](std::size_t k) {
      const std::size_t p = must_go[k];
      hits_[p] = paths_.find_hits(p, spare_[p]);
    });
    if (!memory_.pairs.empty())
      core::parallel_for(due_.size(), 16, [&](std::size_t k) { remember(due_[k]); });
    report_.ways_tested += static_cast<long>(due_.size());
    hit_.clear();
    for (const std::size_t p : due_) {
      if (hits_[p].empty()) continue;
      hit_.push_back(p);
      report_.hits += was_hit_[p] ? 0 : 1;
      was_hit_[p] = 1;
    }
    return !hit_.empty();
  }

  // Who is struck in his sleep by what others set in motion in this step is no wall.
  bool wakes_sleepers() {
    if (slept_.empty()) return false;
    std::vector<SleeperHit> hits;
    for (const std::size_t p : hit_)
      for (const PathHit& hit : hits_[p]) hits.push_back({static_cast<int>(p), hit.contact});
    find_struck_sleepers(bodies_, settings_, slept_, hits, work_);
    return !work_.to_wake.empty();
  }

  // Of the pairs that are due, those whose tests cannot be recalled.
  std::vector<std::size_t> recall_all() {
    std::vector<std::size_t> unknown;
    for (const std::size_t p : due_)
      if (!recall(p)) unknown.push_back(p);
    return unknown;
  }

  // What the pair's test came to when the part was taken before, if the ends are the same in this as in all
  // that came before it.
  bool recall(std::size_t p) {
    WorkPair& pair = work_.pairs[p];
    if (pair.former < 0) return false;
    const auto& tests = former_.pairs[at(pair.former)].tests;
    const std::size_t next = memory_.pairs[p].tests.size();
    const bool is_same = next < tests.size() && tests[next].a.is_of(work_.bodies[at(pair.a)]) &&
                         tests[next].b.is_of(work_.bodies[at(pair.b)]);
    if (is_same) {
      hits_[p] = tests[next].hits;
      spare_[p] = tests[next].spare;
    } else {
      pair.former = -1;
    }
    return is_same;
  }

  void remember(std::size_t p) {
    if (p >= memory_.pairs.size()) return;
    const WorkBody &a = work_.bodies[at(work_.pairs[p].a)], &b = work_.bodies[at(work_.pairs[p].b)];
    memory_.pairs[p].tests.push_back(
        {{a.end, a.straight_parts, a.knots}, {b.end, b.straight_parts, b.knots}, hits_[p], spare_[p]});
  }

  bool open_in_rounds(bool has_hits) {
    std::size_t hits_before = work_.pairs.size() + 1;
    for (int round = 0; has_hits && round < settings_.continuous_rounds; ++round) {
      const std::size_t hits = hit_.size();
      if (round >= kPatience && hits >= hits_before) break;
      if (round % kPatience == 0) hits_before = hits;
      ++report_.rounds;
      const bool is_last = round + 1 == settings_.continuous_rounds;
      open(is_last ? kLastOpening : kOpening, Yielding::by_mass);
      has_hits = test();
      if (wakes_sleepers()) return false;
    }
    return has_hits;
  }

  // Of these (flags), scripted ones strike the others, if one of those can break: all is taken again with
  // them as free bodies. False if nobody does.
  bool strike(const std::vector<char>& is_pressed, double least_pace) {
    bool may_break = false;
    for (std::size_t i = 0; i < is_pressed.size(); ++i)
      may_break = may_break || (is_pressed[i] && work_.bodies[i].may_break);
    for (std::size_t i = 0; may_break && i < is_pressed.size(); ++i)
      if (is_pressed[i] && can_strike(bodies_[i]) && bodies_[i].script.pace >= least_pace)
        work_.to_strike.push_back(work_.ids[i]);
    return !work_.to_strike.empty();
  }

  bool strikes_held() { return work_.has_scripted && strike(find_held(), 0.0); }
  bool strikes_jammed() { return work_.has_scripted && strike(find_jammed(), 1.0); }
  bool strikes_pressed() { return work_.has_scripted && strike(find_pressed(), 1.0); }

  // Flags: scripted ones, and what stands still, that meet.
  std::vector<char> find_held() const {
    std::vector<char> is_held(work_.bodies.size(), 0);
    for (const std::size_t p : hit_) {
      const int a = work_.pairs[p].a, b = work_.pairs[p].b;
      if (bodies_[at(a)].comes_upon(bodies_[at(b)]) || bodies_[at(b)].comes_upon(bodies_[at(a)]))
        is_held[at(a)] = is_held[at(b)] = 1;
    }
    return is_held;
  }

  // Flags: scripted ones, and what they gave more than would bring all that lies together there to their
  // speed, and stop it and send it back, several times over: it is wedged, against what cannot give way, and
  // nothing bounds what a body without an end of mass gives it.
  std::vector<char> find_jammed() const {
    std::vector<char> is_jammed(work_.bodies.size(), 0);
    for (const Island& island : work_.islands) {
      if (!island.may_break) continue;
      double mass = 0.0, speed = 0.0;
      for (const int i : island.bodies) {
        const WorkBody& w = work_.bodies[at(i)];
        mass += 1.0 / w.inverse_mass;
        speed = std::max(speed, greatest_speed(w.velocity_start, w.spin_start, w.reach) +
                                    w.gravity.norm() * settings_.time_step);
      }
      for (const int k : island.contacts) {
        const SolverContact& c = work_.contacts[at(k)];
        for (const auto& [one, other] : {std::pair(c.a, c.b), std::pair(c.b, c.a)}) {
          const WorkBody& w = work_.bodies[at(one)];
          if (!w.is_scripted || !w.is_active) continue;
          const double usual = mass * (speed + greatest_speed(w.velocity, w.spin, w.reach));
          if (c.total.norm() > kWedged * usual) is_jammed[at(one)] = is_jammed[at(other)] = 1;
        }
      }
    }
    return is_jammed;
  }

  // Scripted bodies that press on what finds no room stop where they first met it, or before, and all is
  // solved anew. False if there are none, or they did not move already.
  bool hold_up_scripted() {
    if (!work_.has_scripted) return false;
    const std::vector<char> is_pressed = find_pressed();
    is_squeezed_.resize(work_.bodies.size(), 0);
    double first = 1.0;
    for (const std::size_t p : hit_) first = std::min(first, hits_[p].front().time);
    std::vector<char> is_held(work_.bodies.size(), 0);
    for (std::size_t i = 0; i < work_.bodies.size(); ++i) {
      WorkBody& w = work_.bodies[i];
      if (!is_pressed[i] || !w.is_scripted || !w.is_active || w.gone <= 0.0) continue;
      const double most = std::min(first, w.gone < 1.0 ? 0.5 * w.gone : 1.0);
      const int substeps = std::min(static_cast<int>(most * settings_.substeps), settings_.substeps - 1);
      hold_up(w, substeps);
      is_held[i] = 1;
    }
    if (std::find(is_held.begin(), is_held.end(), 1) == is_held.end()) return false;
    for (std::size_t i = 0; i < is_pressed.size(); ++i)
      is_squeezed_[i] = is_squeezed_[i] || is_pressed[i] ? 1 : 0;
    std::vector<char> is_dirty(work_.bodies.size(), 0);
    for (const SolverContact& c : work_.contacts) {
      if (is_held[at(c.a)]) is_dirty[at(c.b)] = 1;
      if (is_held[at(c.b)]) is_dirty[at(c.a)] = 1;
    }
    spread_over_openings(is_dirty);
    solve_islands(bodies_, settings_, is_dirty, work_);
    forget_impulses(is_dirty);
    for (std::size_t i = 0; i < is_held.size(); ++i) is_dirty[i] = is_dirty[i] || is_held[i] ? 1 : 0;
    mark_due_with(is_dirty);
    for (auto& hits : known_) hits.clear();
    return true;
  }

  // The number of a body that can be pushed; -1 of others.
  int mover_of(body::BodyId id) const {
    const auto place = std::lower_bound(work_.ids.begin(), work_.ids.end(), id);
    if (place == work_.ids.end() || *place != id) return -1;
    const auto i = static_cast<int>(place - work_.ids.begin());
    return work_.bodies[at(i)].inverse_mass > 0.0 ? i : -1;
  }

  // Who was opened from one that is solved anew is so too, and his island: what opening gave went to both.
  void spread_over_openings(std::vector<char>& is_anew) const {
    for (bool goes_on = true; goes_on;) {
      goes_on = false;
      for (const body::LoggedImpulse& entry : work_.continuous_log) {
        const int a = mover_of(entry.body_a), b = mover_of(entry.body_b);
        if (a < 0 || b < 0 || is_anew[at(a)] == is_anew[at(b)]) continue;
        is_anew[at(a)] = is_anew[at(b)] = 1;
        goes_on = true;
      }
      for (const Island& island : work_.islands) {
        const auto is_one = [&](int i) { return is_anew[at(i)] != 0; };
        const auto& members = island.bodies;
        if (std::none_of(members.begin(), members.end(), is_one) ||
            std::all_of(members.begin(), members.end(), is_one))
          continue;
        for (const int i : members) is_anew[at(i)] = 1;
        goes_on = true;
      }
    }
  }

  // What opening gave to bodies that were solved anew since has not been.
  void forget_impulses(const std::vector<char>& is_anew) {
    const auto counts = [&](body::BodyId id) {
      const int i = mover_of(id);
      return i >= 0 && !is_anew[at(i)];
    };
    std::erase_if(work_.continuous_log,
                  [&](const body::LoggedImpulse& e) { return !counts(e.body_a) && !counts(e.body_b); });
  }

  // Between what is held up and what holds it there is no room for the usual gaps: to insist on them would
  // strain both without end.
  void content_with_less() {
    for (const SolverContact& c : work_.contacts) {
      if (is_squeezed_.empty() || !is_squeezed_[at(c.a)] || !is_squeezed_[at(c.b)]) continue;
      PairState& memory = state_.pairs[at(work_.pairs[at(c.pair)].state)];
      const double least = 0.02 * settings_.kept_gap * work_.pairs[at(c.pair)].size;
      memory.kept_gap = std::min(memory.kept_gap, std::max(least, c.slack + c.kept_gap));
    }
  }

  // The bodies in hits, and from one to the next all that presses on them hard.
  std::vector<char> find_pressed() const {
    std::vector<char> is_pressed(work_.bodies.size(), 0);
    for (const std::size_t p : hit_) is_pressed[at(work_.pairs[p].a)] = is_pressed[at(work_.pairs[p].b)] = 1;
    for (bool goes_on = true; goes_on;) {
      goes_on = false;
      for (const SolverContact& c : work_.contacts) {
        if (is_pressed[at(c.a)] == is_pressed[at(c.b)] || c.impulse[0] <= c.strained_from) continue;
        const int known = is_pressed[at(c.a)] ? c.a : c.b, next = is_pressed[at(c.a)] ? c.b : c.a;
        // What holds still passes nothing on.
        if (work_.bodies[at(known)].inverse_mass == 0.0) continue;
        is_pressed[at(next)] = 1;
        goes_on = true;
      }
    }
    return is_pressed;
  }

  // Hits become contacts of the solver, and the islands that got one are solved anew from the start of the
  // step. False if there is nothing that would gain by it.
  bool solve_again(bool is_first) {
    std::vector<char> is_dirty(work_.bodies.size(), 0);
    const std::vector<char> strikes_on = is_first ? std::vector<char>{} : find_striking();
    const std::vector<char> is_heaped = find_heaped();
    for (const std::size_t p : hit_) {
      const WorkPair& pair = work_.pairs[p];
      if (pair.joint >= 0 || (is_known_[p] && !meets_anew(p))) continue;
      if (!is_first && !may_strike_on(pair, strikes_on)) continue;
      const bool can_act =
          work_.bodies[at(pair.a)].inverse_mass > 0.0 || work_.bodies[at(pair.b)].inverse_mass > 0.0;
      const double depth = find_depth(p);
      // Solids roll and slip on from where they met; surfaces that lie on each other only need room.
      if (!can_act || depth <= (pair.is_analytic ? -kSafe : kDeep) * pair.kept_gap) continue;
      bounces_[p] = is_heaped[p] && depth <= kDeepInHeap * pair.size;
      if (bounces_[p]) continue;
      is_known_[p] = 1;
      for (const PathHit& hit : hits_[p]) add_contact(static_cast<int>(p), hit.contact);
      is_dirty[at(pair.a)] = is_dirty[at(pair.b)] = 1;
    }
    if (std::find(is_dirty.begin(), is_dirty.end(), 1) == is_dirty.end()) return false;
    build_islands(work_);
    const std::vector<Way> before = note_ways();
    work_.is_solved_again = true;
    solve_islands(bodies_, settings_, is_dirty, work_);
    mark_due_since(before);
    return true;
  }

  // What bounced in the step may meet once more, in another place or turned another way.
  bool meets_anew(std::size_t p) {
    return std::any_of(hits_[p].begin(), hits_[p].end(), [&](const PathHit& hit) {
      return find_contact(static_cast<int>(p), hit.contact) == work_.contacts.end();
    });
  }

  // m, by which the hits of a pair overshoot at most.
  double find_depth(std::size_t p) const {
    double depth = -1e300;
    for (const PathHit& hit : hits_[p])
      depth = std::max(depth, -gap_on_way(work_.pairs[p], work_, hit.contact, hit.knot));
    return depth;
  }

  // The bodies in those islands of which this is claimed.
  template <class Claim>
  std::vector<char> find_in_islands(const Claim& claim) const {
    std::vector<char> is_in(work_.bodies.size(), 0);
    for (const Island& island : work_.islands) {
      if (!claim(island)) continue;
      for (const int i : island.bodies) is_in[at(i)] = 1;
    }
    return is_in;
  }

  // The bodies, of those in islands, whose hits run on.
  std::vector<char> find_striking() const {
    return find_in_islands([&](const Island& island) { return strikes_one_by_one(island, work_); });
  }

  // Pairs that are hit with a body in an island that is too large to be solved anew for every hit in it, of
  // which there are some in each step: they are opened as they are, and bounce. But of what may break all
  // that a hit does counts, if it is one, and solids roll and slip on.
  std::vector<char> find_heaped() const {
    const auto in_heap = find_in_islands([](const Island& i) { return i.is_large(); });
    const auto may_break = find_in_islands([](const Island& i) { return i.may_break; });
    std::vector<char> is_heaped(work_.pairs.size(), 0);
    for (const std::size_t p : hit_) {
      const WorkPair& pair = work_.pairs[p];
      const auto breaks = [&](int i) { return work_.bodies[at(i)].may_break || may_break[at(i)]; };
      is_heaped[p] = (in_heap[at(pair.a)] || in_heap[at(pair.b)]) && !pair.is_analytic &&
                     ((!breaks(pair.a) && !breaks(pair.b)) || comes_slowly(p));
    }
    return is_heaped;
  }

  // So that it neither bounces nor is told as a hit: by its way, and by its motion before and after, for who
  // was struck late in the step has gone but a little.
  bool comes_slowly(std::size_t p) const {
    const WorkPair& pair = work_.pairs[p];
    const WorkBody &a = work_.bodies[at(pair.a)], &b = work_.bodies[at(pair.b)];
    return std::all_of(hits_[p].begin(), hits_[p].end(), [&](const PathHit& hit) {
      const Opening o = make_opening(pair, work_, hit.contact, hit.knot, 0.0);
      const double come = hit.start_gap - gap_on_way(pair, work_, hit.contact, hit.knot);
      const Vec3 before =
          a.velocity_start + a.spin_start.cross(o.arm_a) - b.velocity_start - b.spin_start.cross(o.arm_b);
      const Vec3 after = a.velocity + a.spin.cross(o.arm_a) - b.velocity - b.spin.cross(o.arm_b);
      return std::max({come / (hit.knot * settings_.time_step), -o.normal.dot(before),
                       -o.normal.dot(after)}) <= pair.threshold;
    });
  }

  bool may_strike_on(const WorkPair& pair, const std::vector<char>& strikes_on) const {
    const auto is_right = [&](int i) {
      const WorkBody& b = work_.bodies[at(i)];
      return b.is_free || b.inverse_mass == 0.0 || strikes_on[at(i)] != 0;
    };
    return pair.is_analytic && is_right(pair.a) && is_right(pair.b);
  }

  void add_contact(int pair_number, const Contact& found) {
    const PairState& memory = state_.pairs[at(work_.pairs[at(pair_number)].state)];
    const SolverContact fresh = make_solver_contact(memory, work_, pair_number, found);
    const auto same = find_contact(pair_number, found);
    if (same != work_.contacts.end())
      *same = fresh;
    else
      work_.contacts.push_back(fresh);
  }

  // The first of them ascend by pair, as the graph gave them; behind them are those that were added here.
  std::vector<SolverContact>::iterator find_contact(int pair_number, const Contact& found) {
    const bool may_turn = work_.pairs[at(pair_number)].is_analytic;
    const auto is_it = [&](const SolverContact& c) {
      return c.pair == pair_number && c.found.key == found.key &&
             !(may_turn && (c.found.normal - found.normal).norm() > kTurned);
    };
    const auto added = work_.contacts.begin() + static_cast<std::ptrdiff_t>(first_contacts_);
    const auto by_pair = [](const SolverContact& c, int number) { return c.pair < number; };
    auto place = std::lower_bound(work_.contacts.begin(), added, pair_number, by_pair);
    for (; place != added && place->pair == pair_number; ++place)
      if (is_it(*place)) return place;
    return std::find_if(added, work_.contacts.end(), is_it);
  }

  // Opens all hits again in position, to at least this share of the kept gap, together with the contacts of
  // the bodies in them.
  void open(double least_wanted, Yielding yielding) {
    std::vector<char> is_dirty(work_.bodies.size(), 0);
    for (const std::size_t p : hit_) {
      add_to_known(p);
      for (const int i : {work_.pairs[p].a, work_.pairs[p].b})
        is_dirty[at(i)] = work_.bodies[at(i)].inverse_mass > 0.0;
    }
    std::vector<Opening> openings = find_openings(least_wanted, pairs_with(is_dirty));
    mark_due(open_gaps(openings, settings_.time_step, yielding, work_));
  }

  void add_to_known(std::size_t p) {
    for (const PathHit& hit : hits_[p]) {
      std::erase_if(known_[p], [&](const PathHit& k) { return k.contact.key == hit.contact.key; });
      known_[p].push_back(hit);
    }
  }

  // The hits of all rounds, and the contacts, of these pairs.
  std::vector<Opening> find_openings(double least_wanted, const std::vector<std::size_t>& pairs) const {
    std::vector<std::size_t> begin{0};
    for (const std::size_t p : pairs)
      begin.push_back(begin.back() + known_[p].size() + work_.pairs[p].contacts.size());
    std::vector<Opening> openings(begin.back());
    core::parallel_for(pairs.size(), 8, [&](std::size_t k) {
      const std::size_t p = pairs[k];
      const WorkPair& pair = work_.pairs[p];
      std::size_t next = begin[k];
      for (const PathHit& hit : known_[p]) {
        const double wanted =
            std::max(wanted_separation(hit.start_gap, pair.kept_gap), least_wanted * pair.kept_gap);
        openings[next] = make_opening(pair, work_, hit.contact, hit.knot, wanted);
        openings[next++].bounces = bounces_[p] != 0;
      }
      for (const Contact& c : pair.contacts)
        openings[next++] = make_opening(pair, work_, c, 1.0, wanted_separation(c.gap, pair.kept_gap));
    });
    return openings;
  }

  // All pairs in which one of these bodies (flags) is, ascending, and `more`.
  std::vector<std::size_t> pairs_with(const std::vector<char>& is_one,
                                      const std::vector<std::size_t>& more = {}) {
    if (ends_of_body_.items.size() < 2 * work_.pairs.size()) sort_by_body();
    std::vector<char> is_wanted(work_.pairs.size(), 0);
    for (std::size_t i = 0; i < is_one.size(); ++i) {
      if (!is_one[i]) continue;
      for (const int end : ends_of_body_.of(i)) is_wanted[at(end / 2)] = 1;
    }
    for (const std::size_t p : more) is_wanted[p] = 1;
    std::vector<std::size_t> pairs;
    for (std::size_t p = 0; p < is_wanted.size(); ++p)
      if (is_wanted[p]) pairs.push_back(p);
    return pairs;
  }

  void sort_by_body() {
    ends_of_body_ = core::Buckets(work_.bodies.size(), 2 * work_.pairs.size(), [&](std::size_t end) {
      const WorkPair& pair = work_.pairs[end / 2];
      return end % 2 == 0 ? pair.a : pair.b;
    });
  }

  // How bodies went before they were solved anew.
  struct Way {
    Pose end;
    bool is_straight = false;
  };
  std::vector<Way> note_ways() const {
    std::vector<Way> ways;
    ways.reserve(work_.bodies.size());
    for (const WorkBody& w : work_.bodies) ways.push_back({w.end, w.straight_parts == 1});
    return ways;
  }

  // Pairs whose last test leaves more than their ends moved against each other are free still.
  void mark_due_since(const std::vector<Way>& before) {
    std::vector<EndMove> moves(work_.bodies.size());
    for (std::size_t i = 0; i < moves.size(); ++i) {
      const WorkBody& w = work_.bodies[i];
      const bool is_straight = before[i].is_straight && w.straight_parts == 1;
      moves[i].shift = w.end.translation - before[i].end.translation;
      moves[i].turned =
          is_straight ? turn_bound(before[i].end.rotation, w.end.rotation, w.reach) : kElsewhere;
    }
    mark_due(moves);
  }

  static bool is_due(WorkPair& pair, double moved, double& spare) {
    if (moved == 0.0) return false;
    if (moved >= kElsewhere) {
      pair.known.forget_ends(pair.search.get());
      return true;
    }
    spare -= moved;
    pair.known.moved += moved;
    return spare <= 0.0;
  }

  // Surfaces in one zone cannot meet, from now on; what is round keeps its radius, and may have begun too
  // deep.
  bool is_in_one_zone(const WorkPair& pair) {
    return zones_ && !pair.has_sides && zones_->are_one(pair.a, pair.b);
  }

  // Pairs whose last test leaves more than their bodies were moved against each other are free still; who
  // turned by kElsewhere may be anywhere.
  void mark_due(const std::vector<EndMove>& moves) {
    std::vector<char> has_moved(moves.size());
    for (std::size_t i = 0; i < moves.size(); ++i) has_moved[i] = !moves[i].is_none();
    due_.clear();
    for (const std::size_t p : pairs_with(has_moved, hit_)) {
      const bool has_hit = !hits_[p].empty();
      hits_[p].clear();
      WorkPair& pair = work_.pairs[p];
      if (is_in_one_zone(pair)) continue;
      if (is_due(pair, move_between(moves[at(pair.a)], moves[at(pair.b)]), spare_[p]) || has_hit) make_due(p);
    }
    hit_.clear();
    add_missed_pairs();
  }

  void mark_due_with(const std::vector<char>& has_moved) {
    std::vector<EndMove> moves(has_moved.size());
    for (std::size_t i = 0; i < moves.size(); ++i) moves[i].turned = has_moved[i] ? kElsewhere : 0.0;
    mark_due(moves);
  }

  // The last resort: bodies that are still in each other's way go as one, and as far as what cannot be moved
  // lets them; `stops`: not at all. Ends always: the start is free.
  void go_in_zones(bool stops) {
    for (const std::size_t p : hit_) {
      in_zone_[p] = 1;
      known_[p] = hits_[p];
      const int a = work_.pairs[p].a, b = work_.pairs[p].b;
      // Boxes and balls are followed as they turn, not along straight lines.
      if (!stops && !work_.pairs[p].is_analytic && zones_->unite(a, b)) continue;
      const double time = hits_[p].front().time;
      for (const int i : {a, b}) zones_->limit(i, stops || time < 0.05 ? 0.0 : 0.8 * time);
    }
    const std::vector<Way> before = note_ways();
    const std::vector<char> has_moved = zones_->go();
    for (std::size_t i = 0; i < has_moved.size(); ++i) was_cut_[i] = was_cut_[i] || has_moved[i] ? 1 : 0;
    mark_due_since(before);
  }

  // Who meets a zone gives way to it first: if all that two united bodies came upon went with them, so would
  // soon all that lies close.
  bool open_zones_in_rounds(bool has_hits) {
    Patience patience(kZonePatience, 0);
    for (int round = 0; has_hits && round < kZoneOpenings && patience.lasts(hit_.size()); ++round) {
      open_zones();
      has_hits = test();
    }
    return has_hits;
  }

  // What zones meet on their ways is opened as other hits are, with them as wholes.
  void open_zones() {
    std::vector<char> is_due_zone(work_.bodies.size(), 0), is_in_one = is_due_zone;
    for (const std::size_t p : hit_) {
      add_to_known(p);
      for (const int i : {work_.pairs[p].a, work_.pairs[p].b}) is_due_zone[at(zones_->zone_of(i))] = 1;
    }
    for (std::size_t i = 0; i < is_in_one.size(); ++i)
      is_in_one[i] = is_due_zone[at(zones_->zone_of(static_cast<int>(i)))];
    std::vector<std::size_t> pairs = pairs_with(is_in_one);
    std::erase_if(pairs, [&](std::size_t p) {
      return zones_->zone_of(work_.pairs[p].a) == zones_->zone_of(work_.pairs[p].b);
    });
    std::vector<Opening> openings = find_openings(kLastOpening, pairs);
    mark_due(zones_->open(openings, settings_.time_step));
  }

  // Velocities lose what closes between the bodies of a zone, by impulses between them, and what gravity gave
  // on the part of the way that was not gone.
  void settle_zones() {
    std::vector<Opening> openings;
    for (std::size_t p = 0; p < work_.pairs.size(); ++p) {
      if (!in_zone_[p]) continue;
      for (const PathHit& hit : known_[p])
        openings.push_back(make_opening(work_.pairs[p], work_, hit.contact, 1.0, 0.0));
    }
    for (std::size_t i = 0; i < work_.bodies.size(); ++i) {
      WorkBody& w = work_.bodies[i];
      if (!was_cut_[i]) continue;
      ++work_.failsafe_bodies;
      if (w.inverse_mass > 0.0 && zones_->share(static_cast<int>(i)) < 1.0) hold_back(i, w);
    }
    remove_approach(openings, std::nullopt, body::ImpulseKind::failsafe, 30, work_);
  }

  // A pose that gravity did not move gets no speed from it.
  void hold_back(std::size_t i, WorkBody& w) {
    const double g = w.gravity.norm();
    if (g == 0.0) return;
    const Vec3 down = w.gravity / g;
    const double speed = down.dot(w.velocity), before = down.dot(w.velocity_start);
    const double fallen = down.dot(w.end.translation - w.start.translation);
    const double excess = g * (0.5 * (speed + before) * settings_.time_step - fallen);
    if (speed <= 0.0 || excess <= 0.0) return;
    const double kept = std::sqrt(std::max(0.0, speed * speed - 2.0 * excess));
    const Vec3 change = (kept - speed) * down;
    w.velocity += change;
    body::LoggedImpulse entry;
    entry.kind = body::ImpulseKind::failsafe;
    entry.body_a = work_.ids[i];
    entry.point_world = w.end.translation;
    entry.normal_world = -down;
    entry.impulse_world = change / w.inverse_mass;
    entry.impulse_a = w.end.rotation.conjugate() * entry.impulse_world;
    work_.continuous_log.push_back(entry);
  }

  double kept_bytes() const {
    if (report_.ways_tested == 0) return 0.0;
    const std::size_t a_pair = sizeof(spare_[0]) + 2 * sizeof(hits_[0]) + 3 * sizeof(was_hit_[0]);
    return static_cast<double>(work_.pairs.size() * a_pair);
  }

  void note_trouble() {
    for (std::size_t p = 0; p < work_.pairs.size(); ++p) {
      if (was_hit_[p]) state_.pairs[at(work_.pairs[p].state)].trouble_age = -1;
    }
  }

  // Who is hooked to whom, and goes on with him as one; and how many are cut short for others, or held up:
  // shorter parts may help those.
  void note_hooked() {
    std::vector<char> is_new(zones_ ? work_.bodies.size() : 0, 0);
    for (std::size_t p = 0; p < work_.pairs.size(); ++p) {
      PairState& memory = state_.pairs[at(work_.pairs[p].state)];
      const int a = work_.pairs[p].a, b = work_.pairs[p].b;
      const bool goes_on = in_zone_[p] && zones_->share(a) == 1.0 && zones_->share(b) == 1.0;
      if (in_zone_[p] && !(goes_on && memory.is_hooked))
        for (const int i : {a, b}) is_new[at(i)] = was_cut_[at(i)];
      memory.is_hooked = goes_on && (memory.is_hooked || work_.is_shortest);
    }
    report_.newly_cut = static_cast<int>(std::count(is_new.begin(), is_new.end(), 1));
  }

  /// Pairs, and those that can move, whoever each of them meets.
  void note_stuck() {
    std::map<body::BodyId, int> cut;
    const auto note = [this](int steps, const PairState& pair) {
      if (steps <= report_.longest_cut) return;
      report_.longest_cut = steps;
      report_.longest_cut_pair = {pair.body_a, pair.body_b};
    };
    for (std::size_t p = 0; p < work_.pairs.size(); ++p) {
      PairState& memory = state_.pairs[at(work_.pairs[p].state)];
      if (work_.pairs[p].passes) continue;
      const bool is_cut = in_zone_[p] && zones_->share(work_.pairs[p].a) < 1.0;
      memory.stuck_steps = is_cut ? memory.stuck_steps + 1 : 0;
      note(memory.stuck_steps, memory);
      if (!is_cut) continue;
      for (const int i : {work_.pairs[p].a, work_.pairs[p].b}) {
        if (!bodies_[at(i)].is_dynamic()) continue;
        const auto before = state_.cut_steps.find(work_.ids[at(i)]);
        const int steps = before != state_.cut_steps.end() ? before->second + 1 : 1;
        cut[work_.ids[at(i)]] = steps;
        note(steps, memory);
      }
    }
    state_.cut_steps = std::move(cut);
  }

  const std::vector<body::Body>& bodies_;
  const ContactSettings& settings_;
  const std::vector<char>& slept_;  // per body, when the step began; empty: nobody sleeps
  ContactState& state_;
  MotionWork& work_;
  ContactReport& report_;
  const std::size_t first_contacts_;  // before any was added here
  const PartMemory& former_;
  PartMemory& memory_;
  PathTest paths_;
  std::optional<ImpactZones> zones_;  // once nothing else helped
  std::vector<std::size_t> due_;      // pairs that must be tested, ascending
  std::vector<std::size_t> hit_;      // those of them whose ways are not free
  core::Buckets ends_of_body_;        // two for each pair, once they are asked for
  std::vector<char> was_cut_, in_zone_, was_hit_;
  std::vector<char> is_known_;              // per pair: the solver was given its hits
  std::vector<char> bounces_;               // per pair: it was not, and bounces where its hits are opened
  std::vector<char> is_squeezed_;           // per body, by a scripted one that was held up; empty: nobody
  std::vector<double> spare_;               // per pair, m: ways this close to those that were tested are free
  std::vector<std::vector<PathHit>> hits_;  // per pair, earliest first
  std::vector<std::vector<PathHit>> known_;  // per pair: hits of all rounds
};

}  // namespace

void guard_motion(const std::vector<body::Body>& bodies, const ContactSettings& settings,
                  const std::vector<char>& slept, ContactState& state, MotionWork& work,
                  ContactReport& report) {
  if (!work.pairs.empty()) Guard(bodies, settings, slept, state, work, report).run();
}

}  // namespace shatterbox::dynamics
