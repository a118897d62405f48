#include "engine/dynamics/pair_contacts.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "engine/collision/analytic_contact.h"
#include "engine/collision/feature_gap.h"
#include "engine/core/index.h"
#include "engine/core/parallel.h"
#include "engine/dynamics/nearest_contacts.h"
#include "engine/dynamics/rest.h"
#include "engine/dynamics/solid_touch.h"

namespace shatterbox::dynamics {
namespace {

using body::ShapeKind;
using collision::Contact;
using core::at;

// Contacts of a pair: how far apart, as a share of its size, and how many. What rolls on something solid
// needs more feet than surfaces that lie on each other.
struct Manifold {
  double radius;
  std::size_t cap;
};
constexpr Manifold kOnSolid = {0.04, 16}, kOnSurface = {0.08, 8};
constexpr std::size_t kFeaturesToTask = 256;
constexpr std::size_t kUsualContacts = 16;  // of a pair that touches, before most are dropped
constexpr std::size_t kManyNear = 512;      // features, of which not all are measured
constexpr double kFastSlack = 0.25;         // of the slack: a list for one step need not last
constexpr int kHangs = 3;                   // steps in a row, cut short
constexpr double kRaiseTime = 0.5;          // s
constexpr double kTouching = 1e-9;          // share of the pair's size: what sinks less only touches
constexpr double kClose = 0.5;              // of the usual gap: there is hardly room for what sweeps leave
constexpr double kImpactWindow = 0.1;       // share of the step after the first hit in which others count

struct Hit {
  double time;
  Contact contact;
};

bool is_sphere(const WorkBody& w) {
  return w.shape->kind == ShapeKind::sphere;
}

// How far a has come towards b along the first contact's normal since then, m. Only of a sphere and a
// surface: what it would meet further on, had the first not held it, it does not.
double depth_at(const WorkBody& a, const WorkBody& b, const Hit& first, double time) {
  const Vec3 way =
      (a.predicted.translation - a.start.translation) - (b.predicted.translation - b.start.translation);
  return -(time - first.time) * way.dot(first.contact.normal);
}

void keep_first_hits(const WorkBody& a, const WorkBody& b, std::vector<Hit>& hits, const WorkPair& pair,
                     double usual_gap, std::vector<Contact>& out) {
  std::sort(hits.begin(), hits.end(), [](const Hit& x, const Hit& y) {
    return x.time < y.time || (x.time == y.time && x.contact.key < y.contact.key);
  });
  if (is_sphere(a) || is_sphere(b)) {
    const Hit first = hits.front();
    std::erase_if(hits, [&](const Hit& hit) {
      return depth_at(a, b, first, hit.time) * first.contact.normal.dot(hit.contact.normal) > usual_gap;
    });
  }
  std::vector<Contact> kept;
  for (const Hit& hit : hits) {
    if (hit.time > hits.front().time + kImpactWindow) break;
    kept.push_back(hit.contact);
  }
  for (const Contact& c : out) std::erase_if(kept, [&](const Contact& k) { return k.key == c.key; });
  collision::reduce_manifold(kept, {}, 0.0, kOnSolid.radius * pair.size, kOnSurface.cap);
  out.insert(out.end(), kept.begin(), kept.end());
}

double least_on_path(double gap, double kept_gap) {
  return gap > 0.0 ? std::min(kept_gap, 0.8 * gap) : gap - kept_gap;
}

// All features that are near now, for as many steps as the pair stays about here. Boxes are rough: of a pair
// that stays, what is not in truth so near need not be looked at again and again.
std::shared_ptr<const FeatureSearch> search_near(const WorkBody& a, const WorkBody& b, double margin,
                                                 bool stays) {
  auto search = std::make_shared<FeatureSearch>();
  search->margin = margin;
  search->start_a = a.start;
  search->start_b = b.start;
  collision::FeatureList& features = search->features;
  collision::list_near_features(a.placed, b.placed, margin, features);
  if (!stays) return search;
  core::parallel_for(features.size(), kFeaturesToTask, [&](std::size_t i) {
    collision::FeaturePair& f = features[i];
    f.bound = std::max(f.bound, bound_of(meet_at_start(a, b, f).gap.gap));
  });
  std::erase_if(features, [&](const auto& f) { return f.bound > margin; });
  return search;
}

// What some features of a pair come to.
struct PairMeeting {
  double least_gap = 1e300;  // m, at the start
  bool is_free = true;
  std::vector<Contact> contacts;
  std::vector<Hit> hits;  // of those that are not near yet, on the predicted paths

  void add(PairMeeting&& other) {
    least_gap = std::min(least_gap, other.least_gap);
    is_free = is_free && other.is_free;
    contacts.insert(contacts.end(), other.contacts.begin(), other.contacts.end());
    hits.insert(hits.end(), other.hits.begin(), other.hits.end());
  }
};

void follow_prediction(const WorkBody& a, const WorkBody& b, double usual_gap,
                       const collision::FeaturePair& features, const collision::FeaturePoints& start,
                       const collision::FeatureGap& gap, const Vec3& hint, PairMeeting& meeting) {
  const auto end =
      collision::gather(features, *a.collider, a.predicted_vertices, *b.collider, b.predicted_vertices);
  const auto path = collision::follow_paths(start, end, least_on_path(gap.gap, usual_gap), hint, &gap);
  if (path.has_hit)
    meeting.hits.push_back({path.time, collision::contact_at_impact(features, start, path.gap)});
}

// Features [begin, end) of the pair's search, of those that may be near enough for a contact. `start_gaps`
// are bounds, and become gaps where these are measured.
PairMeeting meet_some(const WorkBody& a, const WorkBody& b, double usual_gap, std::size_t begin,
                      std::size_t end, const WorkPair& pair, std::vector<float>& start_gaps) {
  PairMeeting meeting;
  const double looked =
      pair.looks_ahead && !pair.is_fast ? std::max(pair.margin, pair.motion + usual_gap) : pair.margin;
  for (std::size_t i = begin; i < end; ++i) {
    float& start_gap = start_gaps[i];
    if (start_gap > looked) {
      meeting.is_free = meeting.is_free && (pair.is_fast || start_gap > pair.motion + usual_gap);
      continue;
    }
    const collision::FeaturePair& features = pair.search->features[i];
    const auto [start, hint, gap] = meet_at_start(a, b, features);
    start_gap = bound_of(gap.gap);
    meeting.least_gap = std::min(meeting.least_gap, gap.gap);
    if (is_contact(a, b, features, gap, usual_gap, pair.margin)) {
      if (meeting.contacts.empty()) meeting.contacts.reserve(kUsualContacts);
      meeting.contacts.push_back(collision::contact_here(features, start, gap));
      meeting.is_free = false;
      continue;
    }
    if (gap.gap > pair.motion + usual_gap) continue;
    if (pair.looks_ahead)
      follow_prediction(a, b, usual_gap, features, start, gap, hint, meeting);
    else
      meeting.is_free = false;
  }
  return meeting;
}

PairMeeting meet_all(const WorkBody& a, const WorkBody& b, double usual_gap, const WorkPair& pair,
                     std::vector<float>& start_gaps) {
  const std::size_t count = start_gaps.size();
  if (count <= kFeaturesToTask) return meet_some(a, b, usual_gap, 0, count, pair, start_gaps);
  std::vector<PairMeeting> found((count + kFeaturesToTask - 1) / kFeaturesToTask);
  core::parallel_chunks(count, kFeaturesToTask, [&](std::size_t begin, std::size_t end) {
    found[begin / kFeaturesToTask] = meet_some(a, b, usual_gap, begin, end, pair, start_gaps);
  });
  PairMeeting whole;
  for (PairMeeting& some : found) whole.add(std::move(some));
  return whole;
}

// Itself, if nobody else holds it.
std::shared_ptr<StartGaps> own(std::shared_ptr<const StartGaps>&& gaps) {
  if (gaps.use_count() == 1) return std::const_pointer_cast<StartGaps>(std::move(gaps));
  return std::make_shared<StartGaps>(*gaps);
}

// Whether the nearest of so many features are contacts, and nothing has to be known of the others: none is
// followed on its way, and whether surfaces cross was asked before.
bool has_many_near(const WorkBody& a, const WorkBody& b, double usual_gap, const PairState& memory,
                   const WorkPair& pair, const std::vector<float>& start_gaps) {
  if (start_gaps.size() < kManyNear || pair.is_fast || pair.is_first_seen || memory.is_exempt) return false;
  if (a.collider->radius > 0.0 || b.collider->radius > 0.0) return false;
  if (pair.looks_ahead && pair.motion + usual_gap > std::min(kAlwaysNear * usual_gap, pair.margin))
    return false;
  const auto near =
      std::count_if(start_gaps.begin(), start_gaps.end(), [&](float gap) { return !(gap > pair.margin); });
  return static_cast<std::size_t>(near) >= kManyNear;
}

// Contacts, or, of very many, what tells them.
std::optional<NearestContacts> meet_features(const ContactSettings& settings, const MotionWork& work,
                                             PairState& memory, WorkPair& pair) {
  const WorkBody &a = work.bodies[at(pair.a)], &b = work.bodies[at(pair.b)];
  const double slack = settings.search_slack * pair.size;
  const bool one_turns_far = turns_far(a) || turns_far(b);
  pair.least_gap = pair.margin;
  if (one_turns_far && pair.is_fast &&
      clearance_of_balls(a, a.predicted, b, b.predicted, pair.margin) > pair.margin) {
    memory.forget_caches();
    pair.is_free_certified = true;
    return std::nullopt;
  }
  const double usual_gap = settings.kept_gap * pair.size;
  std::shared_ptr<StartGaps> gaps;
  if (pair.is_fast) {
    gaps = std::make_shared<StartGaps>(
        gaps_of(search_paths(a, a.predicted, b, b.predicted, pair.margin + kFastSlack * slack)));
  } else if (pair.needs_search) {
    pair.beyond = pair.margin + slack;
    gaps = std::make_shared<StartGaps>(gaps_of(search_near(a, b, pair.beyond, !pair.is_first_seen)));
  } else {
    gaps = own(std::move(memory.gaps));
    carry_gaps(*gaps, a, b);
  }
  pair.search = gaps->search;
  std::optional<NearestContacts> nearest;
  if (has_many_near(a, b, usual_gap, memory, pair, gaps->gaps)) {
    nearest.emplace(a, b, usual_gap, pair, gaps->gaps);
    if (!(nearest->least_gap() <= std::min(kAlwaysNear * usual_gap, pair.margin))) nearest.reset();
  }
  PairMeeting whole;
  if (nearest)
    whole.least_gap = nearest->least_gap();
  else
    whole = meet_all(a, b, usual_gap, pair, gaps->gaps);
  gaps->least = 1e300;
  for (const double gap : gaps->gaps) gaps->least = std::min(gaps->least, gap);
  pair.known.start_gaps = gaps;
  memory.gaps = pair.is_fast ? nullptr : gaps;
  memory.clear = std::min(gaps->least, pair.beyond);  // of paths that were swept nothing is known beyond
  memory.clear_since = a.travelled + b.travelled;
  pair.least_gap = std::min(whole.least_gap, pair.margin);
  pair.contacts = std::move(whole.contacts);
  pair.is_free_certified = !nearest && !one_turns_far && whole.is_free && whole.hits.empty();
  if (!whole.hits.empty()) keep_first_hits(a, b, whole.hits, pair, usual_gap, pair.contacts);
  return nearest;
}

// Spheres and boxes: contacts at the start, and the first touch on the way if the pair moves further than
// they look.
void meet_solids(const ContactSettings& settings, const MotionWork& work, WorkPair& pair) {
  const WorkBody &a = work.bodies[at(pair.a)], &b = work.bodies[at(pair.b)];
  const double usual_gap = settings.kept_gap * pair.size;
  Vec3 normal;
  pair.least_gap = collision::analytic_gap(*a.shape, a.start, *b.shape, b.start, normal);
  const bool are_boxes = a.shape->kind == body::ShapeKind::box && b.shape->kind == body::ShapeKind::box;
  const double gap =
      are_boxes ? collision::box_contact_gap(*a.shape, a.start, *b.shape, b.start) : pair.least_gap;
  if (gap <= pair.margin) {
    // Once the direction is fixed, all of a face's corners that the motion may bring down belong to the
    // contact.
    collision::find_analytic_contacts(*a.shape, a.start, *b.shape, b.start, pair.margin + pair.motion,
                                      pair.contacts);
    return;
  }
  if (gap > pair.motion + usual_gap) return;
  const SolidTouch touch =
      find_first_touch({a, a.start, a.predicted}, {b, b.start, b.predicted}, usual_gap, pair.margin);
  pair.contacts = touch.contacts;
}

void meet_plane(const MotionWork& work, WorkPair& pair) {
  const WorkBody& plane = work.bodies[at(pair.is_flipped ? pair.a : pair.b)];
  const WorkBody& other = work.bodies[at(pair.is_flipped ? pair.b : pair.a)];
  collision::find_plane_contacts(*other.collider, other.placed.start, plane.start, pair.margin,
                                 pair.contacts);
  pair.least_gap = pair.margin;
  for (const Contact& c : pair.contacts) pair.least_gap = std::min(pair.least_gap, c.gap);
  if (!pair.is_flipped) return;
  for (Contact& c : pair.contacts) {
    std::swap(c.on_a, c.on_b);
    c.normal = -c.normal;
    c.lean = 0.0;
  }
}

void take_gap(const ContactSettings& settings, const MotionWork& work, double kept_gap, WorkPair& pair) {
  pair.kept_gap = kept_gap;
  pair.threshold = impact_threshold(settings, kept_gap);
  const auto is_mesh = [&](int i) { return body::is_mesh(work.bodies[at(i)].shape->kind); };
  pair.is_close = kept_gap < kClose * settings.kept_gap * pair.size && !is_mesh(pair.a) && !is_mesh(pair.b);
}

// The gap that is kept is the usual one unless the pair was found closer: it never pushes newborn pieces
// apart.
void adapt_gap(const ContactSettings& settings, const MotionWork& work, double least, PairState& memory,
               WorkPair& pair) {
  const double usual = settings.kept_gap * pair.size;
  for (const Contact& c : pair.contacts) {
    if (!c.is_time_of_impact) least = std::min(least, c.gap);
  }
  least = std::min(least, usual);
  const bool is_new = memory.kept_gap <= 0.0;
  least = std::max(least, 0.02 * usual);
  // What lies on something solid from the start is raised to the usual gap, slowly enough to be no push.
  const bool is_raised =
      !is_new && (pair.is_plane || pair.is_analytic) && memory.is_touching && pair.earlier < 0;
  if (is_raised) least = std::max(least, memory.kept_gap + usual * settings.time_step / kRaiseTime);
  memory.kept_gap = is_new ? least : std::min(usual, std::max(memory.kept_gap, least));
  take_gap(settings, work, memory.kept_gap, pair);
}

bool is_crossing(const MotionWork& work, const PairState& memory, const WorkPair& pair) {
  const WorkBody &a = work.bodies[at(pair.a)], &b = work.bodies[at(pair.b)];
  if (pair.is_plane || pair.is_analytic) return pair.least_gap < -kTouching * pair.size;
  // A capsule's axis that goes through the middle of a great triangle is near none of its edges.
  if (pair.has_sides)
    return pair.least_gap < -kTouching * pair.size || collision::is_run_through(a.placed, b.placed);
  return collision::crosses(a.placed, b.placed) ||
         (memory.is_exempt && pair.least_gap <= kNoDistance * pair.size);
}

// A capsule whose axis goes through a surface is on both its sides; what lies in a fold of one finds no way
// out of it.
bool has_no_side(const MotionWork& work, const PairState& memory, const WorkPair& pair) {
  if (!pair.has_sides) return true;
  if (pair.is_plane || pair.is_analytic) return false;
  if (memory.stuck_steps >= kHangs) return true;
  const WorkBody &a = work.bodies[at(pair.a)], &b = work.bodies[at(pair.b)];
  const double radius = a.collider->radius + b.collider->radius;
  return pair.least_gap <= kNoDistance * pair.size - radius || collision::is_run_through(a.placed, b.placed);
}

}  // namespace

void find_pair_contacts(const ContactSettings& settings, const MotionWork& work, PairState& memory,
                        WorkPair& pair) {
  if (pair.is_apart) {
    pair.least_gap = pair.clearance;
    pair.is_free_certified = true;
    memory.is_exempt = false;
    adapt_gap(settings, work, 1e300, memory, pair);
    return;
  }
  if (pair.is_plane) meet_plane(work, pair);
  if (pair.is_analytic) meet_solids(settings, work, pair);
  std::optional<NearestContacts> nearest =
      pair.is_plane || pair.is_analytic ? std::nullopt : meet_features(settings, work, memory, pair);
  if (pair.is_first_seen || memory.is_exempt) {
    memory.is_exempt = is_crossing(work, memory, pair);
    pair.passes = memory.is_exempt && has_no_side(work, memory, pair);
    if (pair.passes) pair.contacts.clear();
  }
  adapt_gap(settings, work, nearest ? nearest->least_gap() : 1e300, memory, pair);
  std::vector<std::uint64_t> loaded;
  for (const auto& c : memory.contacts) {
    if (c.was_loaded) loaded.push_back(c.feature_key);
  }
  const Manifold manifold = pair.has_sides ? kOnSolid : kOnSurface;
  const bool is_in_trouble = memory.trouble_age < 30;
  const double radius = manifold.radius * pair.size * (is_in_trouble ? 0.5 : 1.0);
  const std::size_t cap = manifold.cap * (is_in_trouble ? 2 : 1);
  const double loaded_reach = 2.0 * pair.kept_gap;
  if (nearest)
    pair.contacts = nearest->keep(loaded, loaded_reach, {radius, cap});
  else
    collision::reduce_manifold(pair.contacts, loaded, loaded_reach, radius, cap);
}

void meet_again(const ContactSettings& settings, const PartMemory::Pair& former, const MotionWork& work,
                PairState& memory, WorkPair& pair) {
  pair.least_gap = former.least_gap;
  pair.contacts = former.contacts;
  pair.is_free_certified = former.is_free_certified;
  pair.search = former.gaps ? former.gaps->search : nullptr;
  pair.known.start_gaps = former.gaps;
  memory.gaps = former.keeps_gaps ? former.gaps : nullptr;
  memory.is_exempt = former.is_exempt;
  pair.passes = former.passes;
  memory.kept_gap = former.kept_gap;
  take_gap(settings, work, memory.kept_gap, pair);
}

}  // namespace shatterbox::dynamics
