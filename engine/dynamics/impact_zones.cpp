#include "engine/dynamics/impact_zones.h"

#include <algorithm>

#include "engine/core/index.h"
#include "engine/dynamics/joint_work.h"

namespace shatterbox::dynamics {
namespace {

using core::at;

// Several bodies as one.
struct Whole {
  double mass = 0.0;            // kg
  Vec3 centre = Vec3::Zero();   // m
  Mat3 inertia = Mat3::Zero();  // kg m2, world, about the centre
  body::LockedAxes locked;
};

// A turn about the common centre moves its members along all axes but that of the turn.
void lock_turns_of_members(body::LockedAxes& locked) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!locked.moves[axis]) continue;
    for (std::size_t other = 0; other < 3; ++other)
      locked.turns[other] = locked.turns[other] || other != axis;
  }
}

// `pose`: at the start or at the end.
Whole gather_whole(const std::vector<int>& members, const MotionWork& work, Pose WorkBody::*pose) {
  Whole whole;
  for (const int i : members) {
    const double own = 1.0 / work.bodies[at(i)].inverse_mass;
    whole.mass += own;
    whole.centre += own * (work.bodies[at(i)].*pose).translation;
  }
  whole.centre /= whole.mass;
  for (const int i : members) {
    const WorkBody& w = work.bodies[at(i)];
    const Vec3 arm = (w.*pose).translation - whole.centre;
    whole.inertia += inertia_at(w, (w.*pose).rotation) +
                     (arm.squaredNorm() * Mat3::Identity() - arm * arm.transpose()) / w.inverse_mass;
    whole.locked.unite(w.locked);
  }
  if (members.size() > 1) lock_turns_of_members(whole.locked);
  return whole;
}

}  // namespace

ImpactZones::ImpactZones(MotionWork& work)
    : work_(work),
      zones_(join_bodies(work)),
      shares_(work.bodies.size(), 1.0),
      limits_(work.bodies.size(), 1.0),
      is_united_(work.bodies.size(), 0),
      is_whole_(work.bodies.size(), 0) {}

bool ImpactZones::unite(int a, int b) {
  if (!(work_.bodies[at(a)].inverse_mass > 0.0) || !(work_.bodies[at(b)].inverse_mass > 0.0)) return false;
  if (zone_of(a) == zone_of(b) || share(a) < 1.0 || share(b) < 1.0) return false;
  const double limit = std::min(limits_[at(zone_of(a))], limits_[at(zone_of(b))]);
  zones_.unite(a, b);
  const std::size_t zone = at(zone_of(a));
  is_whole_[zone] = is_united_[zone] = 1;
  limits_[zone] = limit;
  return true;
}

void ImpactZones::limit(int body, double share) {
  double& least = limits_[at(zone_of(body))];
  least = std::min(least, share);
}

std::vector<char> ImpactZones::go() {
  std::vector<char> has_moved(work_.bodies.size(), 0);
  std::vector<std::vector<int>> members(work_.bodies.size());
  for (int i = 0; at(i) < members.size(); ++i) {
    const std::size_t zone = at(zone_of(i));
    if (!work_.bodies[at(i)].is_active || (!is_united_[zone] && limits_[zone] >= 1.0)) continue;
    members[zone].push_back(i);
    has_moved[at(i)] = 1;
  }
  for (std::size_t zone = 0; zone < members.size(); ++zone) {
    if (is_whole_[zone] && !members[zone].empty()) {
      go_as_one(members[zone], limits_[zone]);
    } else {
      // Who is joined goes as far as the one who is stopped first.
      for (const int i : members[zone]) shorten(work_.bodies[at(i)], limits_[zone]);
    }
    shares_[zone] *= limits_[zone];
  }
  std::fill(limits_.begin(), limits_.end(), 1.0);
  std::fill(is_united_.begin(), is_united_.end(), 0);
  return has_moved;
}

void ImpactZones::go_as_one(const std::vector<int>& members, double share) {
  const Whole whole = gather_whole(members, work_, &WorkBody::start);
  Vec3 way = Vec3::Zero(), momentum = Vec3::Zero();  // m; kg m2 rad
  for (const int i : members) {
    const WorkBody& w = work_.bodies[at(i)];
    const Vec3 own_momentum = (w.end.translation - w.start.translation) / w.inverse_mass;
    way += own_momentum / whole.mass;
    momentum += (w.start.translation - whole.centre).cross(own_momentum) +
                inertia_at(w, w.start.rotation) * turn_between(w.start.rotation, w.end.rotation);
  }
  way = whole.locked.let_move(way);
  // Beyond half a radian straight paths would cut the corner.
  const Vec3 turn = whole.locked.invert(whole.inertia) * momentum;
  const double angle = turn.norm();
  const double turned = std::min(share, angle > 0.0 ? 0.99 * kStraightTurn / angle : 1.0);
  const Quat rotation = rotation_by(turned * turn);
  for (const int i : members) {
    WorkBody& w = work_.bodies[at(i)];
    w.is_free = false;
    w.knots.clear();
    w.straight_parts = 1;
    w.turn_angle = turned * angle;
    turn_end(w, share > 0.0 ? (rotation * w.start.rotation).normalized() : w.start.rotation);
    w.end.translation = w.start.translation;
    if (!(share > 0.0)) continue;
    w.end.translation = whole.centre + share * way + rotation * (w.start.translation - whole.centre);
    if (w.locked.any())  // to the last bit
      w.end.translation = w.start.translation + w.locked.let_move(w.end.translation - w.start.translation);
  }
}

std::vector<EndMove> ImpactZones::open(std::vector<Opening>& openings, double time_step) {
  std::vector<std::vector<int>> members(work_.bodies.size());
  for (int i = 0; at(i) < members.size(); ++i)
    if (work_.bodies[at(i)].inverse_mass > 0.0 && share(i) >= 1.0) members[at(zone_of(i))].push_back(i);
  std::vector<Mover> movers(members.size());
  std::vector<Vec3> centres(members.size(), Vec3::Zero());
  for (std::size_t zone = 0; zone < members.size(); ++zone) {
    if (members[zone].empty()) continue;
    const Whole whole = gather_whole(members[zone], work_, &WorkBody::end);
    movers[zone] = {1.0 / whole.mass, whole.locked, whole.locked.invert(whole.inertia)};
    centres[zone] = whole.centre;
  }
  std::vector<Opening> of_zones = openings;
  for (Opening& o : of_zones) {
    for (auto [body, arm] : {std::pair(&o.a, &o.arm_a), std::pair(&o.b, &o.arm_b)}) {
      const std::size_t zone = at(zone_of(*body));
      *arm += work_.bodies[at(*body)].end.translation - centres[zone];
      *body = static_cast<int>(zone);
    }
    o.weight = opening_weight(o, movers[at(o.a)], movers[at(o.b)], Yielding::by_mass);
  }
  const Moves moves = relax(of_zones, movers, Yielding::by_mass);
  for (std::size_t k = 0; k < openings.size(); ++k) openings[k].impulse = of_zones[k].impulse;
  std::erase_if(openings, [](const Opening& o) { return o.impulse <= 0.0; });
  remove_approach(openings, time_step, body::ImpulseKind::continuous, 1, work_);
  std::vector<EndMove> moved(work_.bodies.size());
  for (std::size_t zone = 0; zone < members.size(); ++zone) {
    if (moves.shifts[zone].isZero(0.0) && moves.turns[zone].isZero(0.0)) continue;
    const Quat rotation = rotation_by(moves.turns[zone]);
    for (const int i : members[zone]) {
      WorkBody& w = work_.bodies[at(i)];
      const Vec3 arm = w.end.translation - centres[zone];
      moved[at(i)] = move_end(w, moves.shifts[zone] + (rotation * arm - arm), moves.turns[zone]);
    }
  }
  return moved;
}

}  // namespace shatterbox::dynamics
