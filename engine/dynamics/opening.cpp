#include "engine/dynamics/opening.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/collision/feature_gap.h"
#include "engine/core/index.h"
#include "engine/dynamics/contact_place.h"

namespace shatterbox::dynamics {
namespace {

using collision::Contact;
using core::at;

constexpr int kIterations = 20;
constexpr int kIterationsAlike = 60;
constexpr int kSweepsAlike = 30;

Mover mover_of(const WorkBody& w) {
  return {w.inverse_mass, w.locked, inverse_inertia_at(w, w.end.rotation)};
}

void give(MotionWork& work, const Opening& o, double size, double closing, body::ImpulseKind kind) {
  WorkBody &a = work.bodies[at(o.a)], &b = work.bodies[at(o.b)];
  const Vec3 p = size * o.normal;
  if (a.inverse_mass > 0.0) {
    a.velocity += a.locked.let_move(a.inverse_mass * p);
    a.spin += inverse_inertia_at(a, a.end.rotation) * o.arm_a.cross(p);
  }
  if (b.inverse_mass > 0.0) {
    b.velocity -= b.locked.let_move(b.inverse_mass * p);
    b.spin -= inverse_inertia_at(b, b.end.rotation) * o.arm_b.cross(p);
  }
  body::LoggedImpulse entry = body::log_impulse(kind, work.ids[at(o.a)], a.end, work.ids[at(o.b)], b.end,
                                                a.end.translation + o.arm_a, o.normal, p);
  entry.closing_speed = closing;
  entry.effective_mass = o.weight;
  work.continuous_log.push_back(entry);
}

Moved moved_to(const WorkBody& w, const Pose& pose) {
  const Vec3 way = pose.translation - w.start.translation;
  if (w.shape->kind == body::ShapeKind::sphere) return {way, Mat3::Identity()};
  return {way, pose.rotation.toRotationMatrix() * w.start.rotation.toRotationMatrix().transpose()};
}

// Where a point of the surface that is at `point` at the start is at the share `time` of the step: vertices
// go straight from knot to knot.
Vec3 on_straight_way(const WorkBody& w, const Vec3& point, double time) {
  const double parts = w.straight_parts, part = std::min(std::floor(time * parts), parts - 1.0);
  const Vec3 from = carry(w, point, w.start, pose_on_way(w, part / parts));
  const Vec3 to = carry(w, point, w.start, pose_on_way(w, (part + 1.0) / parts));
  return from + (time * parts - part) * (to - from);
}

struct PlaceOnWay {
  Vec3 centre_a, centre_b, on_a, on_b, normal;
  double gap = 0.0;  // m
};

// Where a contact seen from the start is at the share `knot` of the step. What touches of a capsule slides
// along it: there its features are measured anew.
PlaceOnWay meet_on_way(const WorkPair& pair, const MotionWork& work, const Contact& contact, double knot) {
  const WorkBody &a = work.bodies[at(pair.a)], &b = work.bodies[at(pair.b)];
  const Pose pose_a = pose_on_way(a, knot), pose_b = pose_on_way(b, knot);
  const bool has_capsule =
      a.shape->kind == body::ShapeKind::capsule || b.shape->kind == body::ShapeKind::capsule;
  if (has_capsule && !pair.is_plane) {
    const auto features = collision::FeaturePair::of_key(contact.key);
    const auto points = collision::gather(features, *a.collider, pose_a, *b.collider, pose_b);
    const collision::FeatureGap found = collision::measure(points, contact.normal);
    return {pose_a.translation, pose_b.translation, found.on_a, found.on_b, found.normal, found.gap};
  }
  const PlacedContact there = place_contact(a, moved_to(a, pose_a), b, moved_to(b, pose_b), contact);
  PlaceOnWay place{pose_a.translation,
                   pose_b.translation,
                   pose_a.translation + there.arm_a,
                   pose_b.translation + there.arm_b,
                   there.normal,
                   there.gap};
  // What solids touch with within one part was found where they turn.
  const bool has_turned = pair.is_analytic && a.straight_parts == b.straight_parts;
  if (pair.is_plane || has_turned || knot == 1.0) return place;
  // A knot of the one is none of the other, if that turns less.
  const Vec3 there_a = on_straight_way(a, contact.on_a, knot),
             there_b = on_straight_way(b, contact.on_b, knot);
  place.gap += place.normal.dot((there_a - place.on_a) - (there_b - place.on_b));
  place.on_a = there_a;
  place.on_b = there_b;
  return place;
}

// Where the features of a contact are at the ends, if they do not meet on straight ways to them.
std::optional<PlaceOnWay> pass_by(const WorkPair& pair, const MotionWork& work, const Contact& contact) {
  const WorkBody &a = work.bodies[at(pair.a)], &b = work.bodies[at(pair.b)];
  if (pair.is_plane || pair.is_analytic || a.straight_parts > 1 || b.straight_parts > 1) return std::nullopt;
  const auto features = collision::FeaturePair::of_key(contact.key);
  const auto start = collision::gather(features, *a.collider, a.start, *b.collider, b.start);
  const auto end = collision::gather(features, *a.collider, a.end, *b.collider, b.end);
  const Vec3 hint = direction_hint(a, b, start);
  const collision::FeatureGap began = collision::measure(start, hint);
  const double least = least_separation(began.gap, pair);
  // Which side is which is known of what was apart.
  if (!(least > 0.0) || collision::follow_paths(start, end, least, hint, &began).has_hit) return std::nullopt;
  const collision::FeatureGap found = collision::measure(end, hint);
  return PlaceOnWay{a.end.translation, b.end.translation, found.on_a, found.on_b, found.normal, found.gap};
}

}  // namespace

double opening_weight(const Opening& o, const Mover& a, const Mover& b, Yielding yielding) {
  double sum = 0.0;
  for (const auto& [m, arm] : {std::pair(&a, &o.arm_a), std::pair(&b, &o.arm_b)}) {
    if (m->inverse_mass <= 0.0) continue;
    const Vec3 moment = arm->cross(o.normal);
    const double own =
        m->inverse_mass * m->locked.share_along(o.normal) + moment.dot(m->inverse_inertia * moment);
    if (own < body::kLeastYield * m->inverse_mass) continue;
    sum += yielding == Yielding::alike ? own / m->inverse_mass : own;
  }
  return sum > 0.0 ? 1.0 / sum : 0.0;
}

Moves relax(std::vector<Opening>& openings, const std::vector<Mover>& movers, Yielding yielding) {
  Moves moves;
  moves.shifts.assign(movers.size(), Vec3::Zero());
  moves.turns.assign(movers.size(), Vec3::Zero());
  const bool is_alike = yielding == Yielding::alike;
  const auto push = [&](int i, const Vec3& impulse, const Vec3& arm) {
    const Mover& m = movers[at(i)];
    if (m.inverse_mass <= 0.0) return;
    const double unit = is_alike ? 1.0 / m.inverse_mass : 1.0;
    moves.shifts[at(i)] += m.locked.let_move(unit * m.inverse_mass * impulse);
    moves.turns[at(i)] += unit * (m.inverse_inertia * arm.cross(impulse));
  };
  std::vector<double> weights;
  for (const Opening& o : openings)
    weights.push_back(is_alike ? opening_weight(o, movers[at(o.a)], movers[at(o.b)], yielding) : o.weight);
  const int iterations = is_alike ? kIterationsAlike : kIterations;
  for (int iteration = 0; iteration < iterations; ++iteration) {
    double greatest = 0.0;
    for (std::size_t k = 0; k < openings.size(); ++k) {
      Opening& o = openings[k];
      const Vec3 relative = moves.shifts[at(o.a)] + moves.turns[at(o.a)].cross(o.arm_a) -
                            moves.shifts[at(o.b)] - moves.turns[at(o.b)].cross(o.arm_b);
      const double missing = (o.wanted - o.gap) / o.share - o.normal.dot(relative);
      const double change = std::max(-o.impulse, missing * weights[k]);
      if (change == 0.0) continue;
      o.impulse += change;
      greatest = std::max(greatest, std::abs(missing));
      push(o.a, change * o.normal, o.arm_a);
      push(o.b, -change * o.normal, o.arm_b);
    }
    if (greatest == 0.0) break;
  }
  return moves;
}

double gap_on_way(const WorkPair& pair, const MotionWork& work, const Contact& contact, double knot) {
  return meet_on_way(pair, work, contact, knot).gap;
}

Opening make_opening(const WorkPair& pair, const MotionWork& work, const Contact& contact, double knot,
                     double wanted) {
  PlaceOnWay there = meet_on_way(pair, work, contact, knot);
  if (there.gap < wanted) there = pass_by(pair, work, contact).value_or(there);
  Opening o;
  o.a = pair.a;
  o.b = pair.b;
  o.normal = there.normal;
  o.share = knot;
  o.is_joined = pair.joint >= 0;
  o.gap = there.gap;
  o.wanted = wanted;
  o.restitution = pair.material.restitution;
  o.threshold = pair.threshold;
  const Vec3 middle = contact.lean * there.on_a + (1.0 - contact.lean) * there.on_b;
  o.arm_a = middle - there.centre_a;
  o.arm_b = middle - there.centre_b;
  o.weight =
      opening_weight(o, mover_of(work.bodies[at(o.a)]), mover_of(work.bodies[at(o.b)]), Yielding::by_mass);
  return o;
}

double move_between(const EndMove& a, const EndMove& b) {
  return ((a.shift - b.shift).norm() + a.turned + b.turned) * (1.0 + 1e-9);
}

EndMove move_end(WorkBody& body, const Vec3& shift, const Vec3& turn) {
  const EndMove move{shift, turn.norm() * body.reach};
  if (!move.is_none()) shift_end(body, shift, turn);
  return move;
}

std::vector<EndMove> open_gaps(std::vector<Opening>& openings, double time_step, Yielding yielding,
                               MotionWork& work) {
  std::vector<Mover> movers(work.bodies.size());
  for (const Opening& o : openings)
    for (const int i : {o.a, o.b})
      if (movers[at(i)].inverse_mass == 0.0) movers[at(i)] = mover_of(work.bodies[at(i)]);
  const Moves moves = relax(openings, movers, yielding);
  std::erase_if(openings, [](const Opening& o) { return o.impulse <= 0.0; });
  if (yielding == Yielding::by_mass)
    remove_approach(openings, time_step, body::ImpulseKind::continuous, 1, work);
  else
    remove_approach(openings, std::nullopt, body::ImpulseKind::continuous, kSweepsAlike, work);
  std::vector<EndMove> moved(work.bodies.size());
  for (std::size_t i = 0; i < work.bodies.size(); ++i)
    moved[i] = move_end(work.bodies[i], moves.shifts[i], moves.turns[i]);
  return moved;
}

void remove_approach(const std::vector<Opening>& openings, std::optional<double> time_step,
                     body::ImpulseKind kind, int sweeps, MotionWork& work) {
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (const Opening& o : openings) {
      if (o.is_joined) continue;
      const WorkBody &a = work.bodies[at(o.a)], &b = work.bodies[at(o.b)];
      const double closing =
          -o.normal.dot(a.velocity + a.spin.cross(o.arm_a) - b.velocity - b.spin.cross(o.arm_b));
      const double most = time_step && !o.bounces ? o.impulse / *time_step : 1e300;
      const double parting = o.bounces && closing > o.threshold ? o.restitution * closing : 0.0;
      const double size = std::min((std::max(0.0, closing) + parting) * o.weight, most);
      if (size > 0.0) give(work, o, size, closing, kind);
    }
  }
}

}  // namespace shatterbox::dynamics
