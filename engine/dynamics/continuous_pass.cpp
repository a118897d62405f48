// Stage: the continuous pass over the straight paths of all vertices from the old to the new rigid pose, with
// hits opened again in position and the paths tested anew; at last steps are cut short. [BFA02], [BHTF07]
// sec. III; departs from both because the tests are by separating directions with a least separation, which
// has no false negatives.
#include <algorithm>
#include <cmath>

#include "engine/collision/analytic_contact.h"
#include "engine/collision/feature_gap.h"
#include "engine/core/parallel.h"
#include "engine/dynamics/motion_work.h"
#include "engine/dynamics/solid_touch.h"
#include "engine/dynamics/step_motion.h"

namespace shatterbox::dynamics {
namespace {

using body::ShapeKind;
using collision::Contact;

constexpr double kSafe = 1e-3;   // least separation after the pass, share of the kept gap
constexpr double kFloor = 1e-5;  // below this a direction is not to be trusted
constexpr int kMostStuckSteps = 12;
constexpr double kSinking =
    0.02;  // solids may sink into each other by this share of the thinner half in a step

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

double least_separation(double gap, double kept_gap) {
  if (gap <= kFloor * kept_gap) return gap * (1.0 - 1e-9);
  return std::max(kFloor * kept_gap, std::min(kSafe * kept_gap, 0.8 * gap));
}

double wanted_separation(double gap, double kept_gap) {
  const double safe = kSafe * kept_gap;
  return gap > 4.0 * safe ? std::max(2.0 * safe, 0.5 * std::min(gap, kept_gap)) : 0.96 * gap;
}

struct Hit {
  double time = 1.0;
  Contact contact;  // seen from the start
};

// One constraint of the local solve on end poses.
struct Opening {
  int a = 0, b = 0;
  int pair = 0;
  Vec3 normal, arm_a, arm_b;  // arms at the end pose, m
  double gap = 0.0;           // m, at the end pose
  double wanted = 0.0;        // m
  double weight = 0.0;        // kg
  double impulse = 0.0;       // kg m, of the displacement
};

class Guard {
 public:
  Guard(const ContactSettings& settings, ContactState& state, MotionWork& work, ContactReport& report)
      : settings_(settings), state_(state), work_(work), report_(report) {}

  void run() {
    must_test_.assign(work_.pairs.size(), 1);
    hits_.resize(work_.pairs.size());
    known_.resize(work_.pairs.size());
    was_cut_.assign(work_.bodies.size(), 0);
    for (std::size_t p = 0; p < work_.pairs.size(); ++p) {
      const WorkPair& pair = work_.pairs[p];
      const WorkBody &a = work_.bodies[at(pair.a)], &b = work_.bodies[at(pair.b)];
      if (pair.is_free_certified && a.is_free && b.is_free) must_test_[p] = 0;
      if (state_.pairs[at(pair.state)].is_exempt) must_test_[p] = 0;
    }
    for (int round = 0; test() && round < settings_.continuous_rounds; ++round) {
      ++report_.rounds;
      open(round + 1 == settings_.continuous_rounds);
    }
    for (int cut = 0; has_hits_; ++cut) {
      cut_short(cut >= 5);
      test();
    }
    note_stuck_pairs();
    for (const char cuts : was_cut_) work_.failsafe_bodies += cuts > 0 ? 1 : 0;
  }

 private:
  // No body hangs for ever: a pair that cannot be solved for many steps (it crossed from the start, or nests)
  // is let pass until it has come apart.
  void note_stuck_pairs() {
    for (std::size_t p = 0; p < work_.pairs.size(); ++p) {
      PairState& memory = state_.pairs[at(work_.pairs[p].state)];
      const bool is_cut = p < is_cut_.size() && is_cut_[p];
      memory.stuck_steps = is_cut ? memory.stuck_steps + 1 : 0;
      if (memory.stuck_steps < kMostStuckSteps || work_.pairs[p].is_plane) continue;
      memory.is_exempt = true;
      ++report_.exempted_pairs;
    }
  }

  bool may_move(int i) const { return work_.bodies[at(i)].inverse_mass > 0.0; }

  // Tests all pairs that are due; true if any path is not free.
  bool test() {
    prepare_paths();
    core::parallel_for(work_.pairs.size(), 8, [&](std::size_t p) {
      const WorkPair& pair = work_.pairs[p];
      if (!must_test_[p]) return;
      hits_[p] = pair.is_plane      ? test_plane(pair)
                 : pair.is_analytic ? test_solids(pair)
                                    : test_features(pair);
    });
    has_hits_ = false;
    for (std::size_t p = 0; p < work_.pairs.size(); ++p) {
      if (!must_test_[p] || hits_[p].empty()) continue;
      has_hits_ = true;
      PairState& memory = state_.pairs[at(work_.pairs[p].state)];
      if (memory.trouble_age != -1) ++report_.hits;
      memory.trouble_age = -1;
    }
    return has_hits_;
  }

  bool needs_descent(const WorkPair& pair) const {
    if (pair.is_plane || pair.is_analytic) return false;
    const WorkBody &a = work_.bodies[at(pair.a)], &b = work_.bodies[at(pair.b)];
    return motion_bound(a, a.end, b, b.end) + pair.kept_gap > pair.list_margin || !pair.features;
  }

  void prepare_paths() {
    std::vector<char> due(work_.bodies.size(), 0);
    for (std::size_t p = 0; p < work_.pairs.size(); ++p) {
      const WorkPair& pair = work_.pairs[p];
      if (!must_test_[p]) continue;
      due[at(pair.a)] = std::max<char>(due[at(pair.a)], needs_descent(pair) ? 2 : 1);
      due[at(pair.b)] = std::max<char>(due[at(pair.b)], needs_descent(pair) ? 2 : 1);
    }
    ends_.resize(work_.bodies.size());
    core::parallel_for(work_.bodies.size(), 8, [&](std::size_t i) {
      WorkBody& w = work_.bodies[i];
      if (!due[i] || w.shape->kind == ShapeKind::plane) return;
      place(w);
      place_at(w, w.end, ends_[i]);
      if (due[i] < 2) return;
      w.end_way = w.end.translation - w.start.translation;
      place_at(w, {w.end.rotation, w.start.translation}, w.turned);
      collision::refit_swept_boxes(w.placed, w.turned);
    });
  }

  std::vector<Hit> test_plane(const WorkPair& pair) const {
    const int plane_number = pair.is_flipped ? pair.a : pair.b,
              other_number = pair.is_flipped ? pair.b : pair.a;
    const WorkBody &plane = work_.bodies[at(plane_number)], &other = work_.bodies[at(other_number)];
    const Vec3 normal = plane.start.rotation * Vec3::UnitY();
    const double level = normal.dot(plane.start.translation) + other.collider->radius;
    std::vector<Hit> hits;
    for (std::size_t v = 0; v < other.placed.start.size(); ++v) {
      const double end = normal.dot(ends_[at(other_number)][v]) - level;
      if (end >= kSafe * pair.kept_gap) continue;
      const double start = normal.dot(other.placed.start[v]) - level;
      if (end >= least_separation(start, pair.kept_gap)) continue;
      Hit hit;
      hit.time = start > end ? std::clamp(start / (start - end), 0.0, 1.0) : 0.0;
      hit.contact.key = v;
      hit.contact.gap = start;
      const Vec3 on_other = other.placed.start[v] - other.collider->radius * normal;
      hit.contact.on_a = pair.is_flipped ? Vec3(on_other - start * normal) : on_other;
      hit.contact.on_b = pair.is_flipped ? on_other : Vec3(on_other - start * normal);
      hit.contact.normal = pair.is_flipped ? Vec3(-normal) : normal;
      hits.push_back(hit);
    }
    keep_first(hits, pair);
    return hits;
  }

  // What has sunk in a little is pushed out by its contacts.
  std::vector<Hit> test_solids(const WorkPair& pair) const {
    const WorkBody &a = work_.bodies[at(pair.a)], &b = work_.bodies[at(pair.b)];
    Vec3 normal;
    const double gap = collision::analytic_gap(*a.shape, a.start, *b.shape, b.start, normal);
    if (gap > motion_bound(a, a.end, b, b.end)) return {};
    const auto thinnest = [](const WorkBody& w) {
      return w.shape->kind == ShapeKind::box ? w.shape->half_extent.minCoeff() : w.shape->radius;
    };
    const double least = std::min(gap, 0.0) - kSinking * std::min(thinnest(a), thinnest(b));
    const SolidTouch touch = find_first_touch(a, a.end, b, b.end, least, pair.kept_gap);
    std::vector<Hit> hits;
    for (const Contact& c : touch.contacts) hits.push_back({touch.time, c});
    keep_first(hits, pair);
    return hits;
  }

  std::vector<Hit> test_features(const WorkPair& pair) const {
    const WorkBody &a = work_.bodies[at(pair.a)], &b = work_.bodies[at(pair.b)];
    const double motion = motion_bound(a, a.end, b, b.end);
    const Vec3 hint = a.start.translation - b.start.translation;
    collision::FeatureList fresh;
    const collision::FeatureList* list = pair.features.get();
    const bool is_fresh = needs_descent(pair);
    if (is_fresh) {
      collision::list_swept_features(a.placed, b.placed, b.end_way - a.end_way, pair.kept_gap, fresh);
      list = &fresh;
    }
    std::vector<Hit> hits;
    for (std::size_t i = 0; i < list->size(); ++i) {
      const double reach = motion + kSafe * pair.kept_gap;
      const bool is_known = !is_fresh && i < pair.gaps.size();
      if (is_known && pair.gaps[i] > reach) continue;
      if (!is_fresh && !is_known && (*list)[i].bound > reach + pair.list_moved) break;
      const auto& features = (*list)[i];
      const auto start =
          collision::gather(features, *a.collider, a.placed.start, *b.collider, b.placed.start);
      const auto end =
          collision::gather(features, *a.collider, ends_[at(pair.a)], *b.collider, ends_[at(pair.b)]);
      const double gap = is_known ? pair.gaps[i] : collision::measure(start, hint).gap;
      // A sphere is solid: sunk in a little, it is pushed out by its contact; only its centre must not pass.
      const double least = start.radius > 0.0 && gap <= kSafe * pair.kept_gap
                               ? std::min(gap - pair.kept_gap, -0.5 * start.radius)
                               : least_separation(gap, pair.kept_gap);
      const auto path = collision::follow_paths(start, end, least, hint);
      if (!path.has_hit) continue;
      Hit hit;
      hit.time = path.time;
      hit.contact = collision::contact_at_impact(features, start, path.gap);
      hits.push_back(hit);
    }
    keep_first(hits, pair);
    return hits;
  }

  void keep_first(std::vector<Hit>& hits, const WorkPair& pair) const {
    std::sort(hits.begin(), hits.end(), [](const Hit& x, const Hit& y) {
      return x.time < y.time || (x.time == y.time && x.contact.key < y.contact.key);
    });
    std::vector<Hit> kept;
    for (const Hit& hit : hits) {
      const bool is_doubled = std::any_of(kept.begin(), kept.end(), [&](const Hit& k) {
        return k.contact.normal.dot(hit.contact.normal) > 0.97 &&
               (k.contact.on_a - hit.contact.on_a).norm() < 0.02 * pair.size;
      });
      if (!is_doubled) kept.push_back(hit);
      if (kept.size() == 6) break;
    }
    hits = std::move(kept);
  }

  Opening make_opening(int pair_number, const Contact& c, double least_wanted) const {
    const WorkPair& pair = work_.pairs[at(pair_number)];
    const WorkBody &a = work_.bodies[at(pair.a)], &b = work_.bodies[at(pair.b)];
    Opening o;
    o.a = pair.a;
    o.b = pair.b;
    o.pair = pair_number;
    o.normal = c.normal;
    const Vec3 end_a = carry(a, c.on_a, a.start, a.end), end_b = carry(b, c.on_b, b.start, b.end);
    o.gap = c.normal.dot(end_a - end_b);
    o.wanted = std::max(wanted_separation(c.gap, pair.kept_gap), least_wanted);
    const Vec3 middle = 0.5 * (end_a + end_b);
    o.arm_a = middle - a.end.translation;
    o.arm_b = middle - b.end.translation;
    double response = a.inverse_mass + b.inverse_mass;
    for (const auto& [w, arm] : {std::pair(&a, o.arm_a), std::pair(&b, o.arm_b)}) {
      if (w->inverse_mass <= 0.0) continue;
      const Vec3 moment = arm.cross(o.normal);
      response += moment.dot(w->inverse_inertia * moment);
    }
    o.weight = response > 0.0 ? 1.0 / response : 0.0;
    return o;
  }

  // Opens all hits again in position, together with the contacts of the bodies in them.
  void open(bool is_last) {
    std::vector<char> is_dirty(work_.bodies.size(), 0);
    std::vector<Opening> openings;
    for (std::size_t p = 0; p < work_.pairs.size(); ++p) {
      if (must_test_[p]) {
        for (const Hit& hit : hits_[p]) {
          std::erase_if(known_[p], [&](const Contact& c) { return c.key == hit.contact.key; });
          known_[p].push_back(hit.contact);
        }
        if (!hits_[p].empty()) is_dirty[at(work_.pairs[p].a)] = is_dirty[at(work_.pairs[p].b)] = 1;
      }
    }
    const auto concerns = [&](const WorkPair& pair) {
      return (is_dirty[at(pair.a)] && may_move(pair.a)) || (is_dirty[at(pair.b)] && may_move(pair.b));
    };
    for (std::size_t p = 0; p < work_.pairs.size(); ++p) {
      const WorkPair& pair = work_.pairs[p];
      if (!concerns(pair)) continue;
      const int number = static_cast<int>(p);
      for (const Contact& c : known_[p]) {
        openings.push_back(make_opening(number, c, (is_last ? 0.05 : 0.5) * pair.kept_gap));
      }
      for (const Contact& c : pair.contacts) openings.push_back(make_opening(number, c, -1e300));
    }
    relax(openings);
    std::erase_if(openings, [](const Opening& o) { return o.impulse <= 0.0; });
    remove_approach(openings);
    retest_moved();
  }

  void relax(std::vector<Opening>& openings) {
    shifts_.assign(work_.bodies.size(), Vec3::Zero());
    turns_.assign(work_.bodies.size(), Vec3::Zero());
    for (int iteration = 0; iteration < 20; ++iteration) {
      for (Opening& o : openings) {
        const Vec3 relative = shifts_[at(o.a)] + turns_[at(o.a)].cross(o.arm_a) - shifts_[at(o.b)] -
                              turns_[at(o.b)].cross(o.arm_b);
        const double missing = o.wanted - o.gap - o.normal.dot(relative);
        const double change = std::max(-o.impulse, missing * o.weight);
        o.impulse += change;
        push(o.a, change * o.normal, o.arm_a, shifts_, turns_);
        push(o.b, -change * o.normal, o.arm_b, shifts_, turns_);
      }
    }
  }

  void push(int i, const Vec3& impulse, const Vec3& arm, std::vector<Vec3>& shifts,
            std::vector<Vec3>& turns) const {
    const WorkBody& w = work_.bodies[at(i)];
    if (w.inverse_mass <= 0.0) return;
    shifts[at(i)] += w.inverse_mass * impulse;
    turns[at(i)] += w.inverse_inertia * arm.cross(impulse);
  }

  // Only takes approach away: no energy can come in.
  void remove_approach(const std::vector<Opening>& openings) {
    for (const Opening& o : openings) {
      WorkBody &a = work_.bodies[at(o.a)], &b = work_.bodies[at(o.b)];
      const double closing =
          -o.normal.dot(a.velocity + a.spin.cross(o.arm_a) - b.velocity - b.spin.cross(o.arm_b));
      const double size = std::min(std::max(0.0, closing) * o.weight, o.impulse / settings_.time_step);
      if (size <= 0.0) continue;
      const Vec3 p = size * o.normal;
      if (a.inverse_mass > 0.0) {
        a.velocity += a.inverse_mass * p;
        a.spin += a.inverse_inertia * o.arm_a.cross(p);
      }
      if (b.inverse_mass > 0.0) {
        b.velocity -= b.inverse_mass * p;
        b.spin -= b.inverse_inertia * o.arm_b.cross(p);
      }
      body::LoggedImpulse entry;
      entry.kind = body::ImpulseKind::continuous;
      entry.body_a = work_.ids[at(o.a)];
      entry.body_b = work_.ids[at(o.b)];
      entry.point_world = a.end.translation + o.arm_a;
      entry.normal_world = o.normal;
      entry.impulse_world = p;
      entry.point_a = a.end.rotation.conjugate() * o.arm_a;
      entry.point_b = b.end.rotation.conjugate() * o.arm_b;
      entry.impulse_a = a.end.rotation.conjugate() * p;
      entry.impulse_b = b.end.rotation.conjugate() * Vec3(-p);
      entry.closing_speed = closing;
      entry.effective_mass = o.weight;
      work_.continuous_log.push_back(entry);
    }
  }

  void retest_moved() {
    std::vector<char> has_moved(work_.bodies.size(), 0);
    for (std::size_t i = 0; i < work_.bodies.size(); ++i) {
      if (shifts_[i].squaredNorm() + turns_[i].squaredNorm() == 0.0) continue;
      WorkBody& w = work_.bodies[i];
      w.end.translation += shifts_[i];
      w.end.rotation = (rotation_by(turns_[i]) * w.end.rotation).normalized();
      w.is_free = false;
      has_moved[i] = 1;
    }
    mark_due(has_moved);
  }

  void mark_due(const std::vector<char>& has_moved) {
    for (std::size_t p = 0; p < work_.pairs.size(); ++p) {
      const WorkPair& pair = work_.pairs[p];
      const bool has_hit = must_test_[p] && !hits_[p].empty();
      must_test_[p] = !state_.pairs[at(pair.state)].is_exempt &&
                              (has_hit || has_moved[at(pair.a)] || has_moved[at(pair.b)])
                          ? 1
                          : 0;
      hits_[p].clear();
    }
  }

  // The last resort: bodies that are still in each other's way stop on theirs. Ends always: the start is
  // free.
  void cut_short(bool all_the_way) {
    std::vector<double> share(work_.bodies.size(), 1.0);
    is_cut_.resize(work_.pairs.size(), 0);
    for (std::size_t p = 0; p < work_.pairs.size(); ++p) {
      if (!must_test_[p] || hits_[p].empty()) continue;
      is_cut_[p] = 1;
      const double time = hits_[p].front().time;
      const double kept = all_the_way || time < 0.05 ? 0.0 : 0.8 * time;
      for (const int i : {work_.pairs[p].a, work_.pairs[p].b}) share[at(i)] = std::min(share[at(i)], kept);
    }
    std::vector<char> has_moved(work_.bodies.size(), 0);
    for (std::size_t i = 0; i < work_.bodies.size(); ++i) {
      WorkBody& w = work_.bodies[i];
      if (share[i] >= 1.0 || !w.is_active) continue;
      has_moved[i] = 1;
      was_cut_[i] = 1;
      w.is_free = false;
      shorten(w, share[i]);
      if (w.inverse_mass <= 0.0) continue;
      body::LoggedImpulse entry;
      entry.kind = body::ImpulseKind::failsafe;
      entry.body_a = work_.ids[i];
      entry.point_world = w.start.translation;
      entry.impulse_world = (share[i] - 1.0) / w.inverse_mass * w.velocity;
      work_.continuous_log.push_back(entry);
      w.velocity *= share[i];
      w.spin *= share[i];
    }
    mark_due(has_moved);
  }

  static void shorten(WorkBody& w, double share) {
    if (share <= 0.0) {
      w.end = w.start;
      return;
    }
    w.end.translation = w.start.translation + share * (w.end.translation - w.start.translation);
    const double sign = w.start.rotation.dot(w.end.rotation) < 0.0 ? -1.0 : 1.0;
    const Quat::Coefficients mixed =
        (1.0 - share) * w.start.rotation.coeffs() + share * sign * w.end.rotation.coeffs();
    w.end.rotation = Quat(mixed).normalized();
  }

  const ContactSettings& settings_;
  ContactState& state_;
  MotionWork& work_;
  ContactReport& report_;
  std::vector<char> must_test_, was_cut_, is_cut_;
  std::vector<std::vector<Hit>> hits_;       // per pair, earliest first
  std::vector<std::vector<Contact>> known_;  // per pair: hits of all rounds
  std::vector<std::vector<Vec3>> ends_;      // per body: vertices at the end pose
  std::vector<Vec3> shifts_, turns_;
  bool has_hits_ = false;
};

}  // namespace

void guard_motion(const ContactSettings& settings, ContactState& state, MotionWork& work,
                  ContactReport& report) {
  if (!work.pairs.empty()) Guard(settings, state, work, report).run();
}

}  // namespace shatterbox::dynamics
