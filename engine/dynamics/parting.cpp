#include "engine/dynamics/parting.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/collision/analytic_contact.h"
#include "engine/core/index.h"
#include "engine/dynamics/motion_work.h"
#include "engine/dynamics/shift_test.h"
#include "engine/geometry/common_inside.h"

namespace shatterbox::dynamics {
namespace {

using body::Body;
using body::ShapeKind;
using core::at;

constexpr double kAside = 0.03;      // of the usual gap: just more than the least that is kept
constexpr double kSideless = 1e-13;  // of how far they are from the origin: nearer surfaces have no side
constexpr double kAlike = 0.9;       // of the contacts' count, is the sum of normals that agree

class Parting {
 public:
  Parting(std::vector<Body>& bodies, const ContactSettings& settings, ContactState& state,
          const MotionWork& work)
      : bodies_(bodies), settings_(settings), state_(state), work_(work) {}

  bool run(std::vector<std::pair<body::BodyId, body::BodyId>>& parted) {
    bool is_changed = false;
    std::vector<const WorkPair*> touching;
    for (const WorkPair& pair : work_.pairs) {
      bool& is_exempt = state_.pairs[at(pair.state)].is_exempt;
      // What crosses may do so by rounding: a foot of a thousand vertices is seldom level to the last bit.
      const bool is_in_one_place = pair.least_gap <= kNoDistance * pair.size && !pair.contacts.empty();
      if (!pair.is_first_seen || pair.has_sides || (!is_exempt && !is_in_one_place)) continue;
      // Blocks that are pushed into each other with their sides in one plane only touch there. What lies in
      // each other too deep to be set aside passes, as what crosses does.
      if (overlap(pair, pair.a, bodies_[at(pair.a)].pose, 2.0 * aside(pair))) {
        is_changed = is_changed || !is_exempt;
        is_exempt = true;
      } else {
        touching.push_back(&pair);
      }
    }
    for (const WorkPair* touched : touching) {
      const WorkPair& pair = *touched;
      if (has_moved(pair.a) || has_moved(pair.b)) continue;
      PairState& memory = state_.pairs[at(pair.state)];
      const bool crossed = memory.is_exempt;
      memory.is_exempt = false;
      const int mover = choose(pair), other = mover == pair.a ? pair.b : pair.a;
      if (!set_aside(pair, mover)) {
        memory.is_exempt = true;
        is_changed = is_changed || !crossed;
        continue;
      }
      is_changed = true;
      moved_.push_back(mover);
      parted.emplace_back(bodies_[at(other)].id, bodies_[at(mover)].id);
    }
    return is_changed;
  }

 private:
  double aside(const WorkPair& pair) const { return kAside * settings_.kept_gap * pair.size; }

  // Deeper than `least` (m), with the mover at that pose.
  bool overlap(const WorkPair& pair, int mover, const Pose& pose, double least) const {
    const auto is_closed = [&](int i) { return body::is_closed(work_.bodies[at(i)].shape->kind); };
    const auto surface = [&](int i) {
      const collision::Collider& collider = *work_.bodies[at(i)].collider;
      geometry::TriangleMesh mesh{{}, collider.triangles};
      collision::place_vertices(collider, i == mover ? pose : bodies_[at(i)].pose, mesh.positions);
      return mesh;
    };
    return is_closed(pair.a) && is_closed(pair.b) &&
           geometry::have_common_inside(surface(pair.a), surface(pair.b), least);
  }

  bool has_moved(int i) const { return std::find(moved_.begin(), moved_.end(), i) != moved_.end(); }

  // What can move; of two, the sheet on a solid, else who came later.
  int choose(const WorkPair& pair) const {
    if (!bodies_[at(pair.a)].is_dynamic()) return pair.b;
    if (!bodies_[at(pair.b)].is_dynamic()) return pair.a;
    const bool b_is_solid = !body::is_mesh(work_.bodies[at(pair.b)].shape->kind);
    return b_is_solid ? pair.a : pair.b;
  }

  Vec3 up() const {
    const double g = settings_.gravity.norm();
    return g > 0.0 ? Vec3(-settings_.gravity / g) : Vec3(Vec3::UnitY() + 0.1 * Vec3::UnitX());
  }

  // The side of b that a is on, if those contacts that are apart tell of one: pieces are born beside each
  // other, and may touch in a point.
  std::optional<Vec3> find_side(const WorkPair& pair) const {
    const double far = bodies_[at(pair.a)].pose.translation.norm() + pair.size;
    Vec3 sum = Vec3::Zero();
    int count = 0;
    for (const collision::Contact& c : pair.contacts) {
      if (!(c.gap > kSideless * far)) continue;
      sum += c.normal;
      ++count;
    }
    if (count == 0 || !(sum.norm() > kAlike * count)) return std::nullopt;
    return Vec3(sum.normalized());
  }

  // From the other towards the mover.
  Vec3 direction(const WorkPair& pair, int mover) const {
    if (const auto side = find_side(pair)) return mover == pair.a ? *side : Vec3(-*side);
    const Vec3 first = pair.contacts.front().normal;
    Vec3 sum = Vec3::Zero();
    for (const collision::Contact& c : pair.contacts) {
      if (c.gap <= kNoDistance * pair.size) sum += c.normal.dot(first) < 0.0 ? Vec3(-c.normal) : c.normal;
    }
    const double length = sum.norm();
    const Vec3 away = length > 0.0 ? Vec3(sum / length) : first;
    Vec3 way = mover == pair.a ? away : Vec3(-away);
    const bool has_solid = !body::is_mesh(work_.bodies[at(pair.a)].shape->kind) ||
                           !body::is_mesh(work_.bodies[at(pair.b)].shape->kind);
    if (!has_solid && way.dot(up()) < 0.0) way = -way;
    return way;
  }

  bool set_aside(const WorkPair& pair, int mover) {
    const double length = aside(pair);
    const int other = mover == pair.a ? pair.b : pair.a;
    const Vec3 between = bodies_[at(mover)].pose.translation - bodies_[at(other)].pose.translation;
    std::vector<Vec3> ways = {up(), -up(), Vec3::UnitX(), -Vec3::UnitX(), Vec3::UnitZ(), -Vec3::UnitZ()};
    if (!pair.contacts.empty()) {
      const Vec3 first = direction(pair, mover);
      ways.insert(ways.begin(), {first, -first});
    }
    if (between.norm() > kSideless * pair.size) ways.push_back(between.normalized());
    for (int k = 0; k < 8; ++k)
      ways.push_back(Vec3(k & 1 ? 1.0 : -1.0, k & 2 ? 1.0 : -1.0, k & 4 ? 1.0 : -1.0).normalized());
    // Rather through nobody; where every way goes through somebody, to where nobody is crossed.
    const Pose start = bodies_[at(mover)].pose;
    std::optional<Pose> chosen;
    for (const Vec3& way : ways) {
      if (bodies_[at(mover)].locked.let_move(way) != way) continue;
      const Pose pose{start.rotation, start.translation + length * way};
      if (!is_free(mover, pose) || overlap(pair, mover, pose, kNoDistance * pair.size)) continue;
      const bool is_clear = !passes_somebody(mover, pose, length);
      if (is_clear || !chosen) chosen = pose;
      if (is_clear) break;
    }
    if (chosen) bodies_[at(mover)].pose = *chosen;
    return chosen.has_value();
  }

  bool is_asked(const WorkPair& pair, int mover) const {
    return (pair.a == mover || pair.b == mover) && !state_.pairs[at(pair.state)].is_exempt;
  }

  bool is_free(int mover, const Pose& pose) const {
    const WorkBody& w = work_.bodies[at(mover)];
    const collision::PlacedCollider placed = collision::place_collider(*w.collider, pose);
    return std::all_of(work_.pairs.begin(), work_.pairs.end(), [&](const WorkPair& pair) {
      if (!is_asked(pair, mover)) return true;
      const int number = pair.a == mover ? pair.b : pair.a;
      const WorkBody& other = work_.bodies[at(number)];
      const Pose& there = bodies_[at(number)].pose;
      if (pair.is_plane) {
        const Vec3 normal = there.rotation * Vec3::UnitY();
        const auto is_above = [&](const Vec3& v) {
          return normal.dot(v - there.translation) >= w.collider->radius;
        };
        return std::all_of(placed.start.begin(), placed.start.end(), is_above);
      }
      Vec3 normal;
      if (pair.is_analytic)
        return collision::analytic_gap(*w.shape, pose, *other.shape, there, normal) >= 0.0;
      return !collision::crosses(placed, collision::place_collider(*other.collider, there));
    });
  }

  // On the way to that pose, `length` (m) from here.
  bool passes_somebody(int mover, const Pose& pose, double length) const {
    const collision::Collider& own = *work_.bodies[at(mover)].collider;
    if (own.radius > 0.0) return false;
    const auto before = collision::place_collider(own, bodies_[at(mover)].pose),
               after = collision::place_collider(own, pose);
    return std::any_of(work_.pairs.begin(), work_.pairs.end(), [&](const WorkPair& pair) {
      if (!is_asked(pair, mover) || pair.is_plane || pair.is_analytic) return false;
      const int number = pair.a == mover ? pair.b : pair.a;
      const collision::Collider& other = *work_.bodies[at(number)].collider;
      return other.radius == 0.0 &&
             goes_through(before, after, collision::place_collider(other, bodies_[at(number)].pose), length);
    });
  }

  std::vector<Body>& bodies_;
  const ContactSettings& settings_;
  ContactState& state_;
  const MotionWork& work_;
  std::vector<int> moved_;  // in this run: their pairs are out of date
};

}  // namespace

bool part_coincident(std::vector<Body>& bodies, const ContactSettings& settings, ContactState& state,
                     const MotionWork& work, std::vector<std::pair<body::BodyId, body::BodyId>>& parted) {
  return Parting(bodies, settings, state, work).run(parted);
}

}  // namespace shatterbox::dynamics
