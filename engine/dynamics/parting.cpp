#include "engine/dynamics/parting.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/collision/analytic_contact.h"
#include "engine/collision/feature_gap.h"
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

  bool run(std::vector<std::pair<body::BodyId, body::BodyId>>& parted, std::vector<body::BodyId>& moved) {
    bool is_changed = false;
    for (const WorkPair& pair : work_.pairs) {
      bool& is_exempt = state_.pairs[at(pair.state)].is_exempt;
      // What crosses may do so by rounding: a foot of a thousand vertices is seldom level to the last bit.
      if (!pair.is_first_seen || pair.has_sides || (!is_exempt && !is_in_one_place(pair))) continue;
      // Blocks that are pushed into each other with their sides in one plane only touch there. What lies in
      // each other too deep to be set aside passes, as what crosses does.
      if (overlap(pair, pair.a, bodies_[at(pair.a)].pose, 2.0 * aside(pair))) {
        is_changed = is_changed || !is_exempt;
        is_exempt = true;
      } else {
        touching_.push_back(&pair);
      }
    }
    for (const WorkPair* touched : touching_) {
      const WorkPair& pair = *touched;
      if (has_moved(pair.a) || has_moved(pair.b)) continue;
      PairState& memory = state_.pairs[at(pair.state)];
      const bool crossed = memory.is_exempt;
      memory.is_exempt = false;
      const int mover = choose(pair), other = mover == pair.a ? pair.b : pair.a;
      if (!set_aside(pair, mover, other)) {
        memory.is_exempt = true;
        is_changed = is_changed || !crossed;
        continue;
      }
      is_changed = true;
      parted.emplace_back(bodies_[at(other)].id, bodies_[at(mover)].id);
    }
    for (const int i : moved_) moved.push_back(bodies_[at(i)].id);
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

  std::vector<Vec3> list_ways(const WorkPair& pair, int mover, int other) const {
    const Vec3 between = bodies_[at(mover)].pose.translation - bodies_[at(other)].pose.translation;
    std::vector<Vec3> ways = {up(), -up(), Vec3::UnitX(), -Vec3::UnitX(), Vec3::UnitZ(), -Vec3::UnitZ()};
    if (!pair.contacts.empty()) {
      const Vec3 first = direction(pair, mover);
      ways.insert(ways.begin(), {first, -first});
    }
    if (between.norm() > kSideless * pair.size) ways.push_back(between.normalized());
    for (int k = 0; k < 8; ++k)
      ways.push_back(Vec3(k & 1 ? 1.0 : -1.0, k & 2 ? 1.0 : -1.0, k & 4 ? 1.0 : -1.0).normalized());
    return ways;
  }

  bool may_go(int i, const Vec3& way) const {
    return bodies_[at(i)].is_dynamic() && bodies_[at(i)].locked.let_move(way) == way;
  }

  Pose shifted(int i, const Vec3& shift) const {
    return {bodies_[at(i)].pose.rotation, bodies_[at(i)].pose.translation + shift};
  }

  // Joints hold it from then on where it is.
  void move(int i, const Vec3& shift) {
    Body& body = bodies_[at(i)];
    body.pose.translation += shift;
    const Vec3 back = body.pose.rotation.conjugate() * shift;
    for (Joint& joint : state_.joints) {
      if (joint.body_a == body.id) joint.frame_a.translation -= back;
      if (joint.body_b == body.id) joint.frame_b.translation -= back;
    }
    moved_.push_back(i);
  }

  bool set_aside(const WorkPair& pair, int mover, int other) {
    const double length = aside(pair);
    const std::vector<Vec3> ways = list_ways(pair, mover, other);
    // Rather through nobody; where every way goes through somebody, to where nobody is crossed.
    std::optional<Vec3> chosen, clear;
    for (const Vec3& way : ways) {
      if (!may_go(mover, way)) continue;
      const Pose pose = shifted(mover, length * way);
      if (!is_free(mover, pose)) continue;
      const bool is_clear = !passes_somebody(mover, pose, length);
      const bool is_parted = is_apart(pair, mover, pose);
      if (is_clear && !clear) clear = way;
      if (is_parted && (is_clear || !chosen)) chosen = way;
      if (is_parted && is_clear) break;
    }
    if (!chosen && push_on(pair, mover, other, ways, length)) return true;
    if (!chosen) chosen = clear;
    if (chosen) move(mover, length * *chosen);
    return chosen.has_value();
  }

  // In a row of blocks one is in the next one's way: they go along.
  bool push_on(const WorkPair& pair, int mover, int other, const std::vector<Vec3>& ways, double length) {
    for (const Vec3& way : ways) {
      if (!is_apart(pair, mover, shifted(mover, length * way))) continue;
      const std::vector<int> company = find_company(mover, other, length * way);
      for (const int i : company) move(i, length * way);
      if (!company.empty()) return true;
    }
    return false;
  }

  // The mover, and from one to the next all whom they would cross, or stay in one place with. Empty: one of
  // them cannot go.
  std::vector<int> find_company(int mover, int other, const Vec3& shift) const {
    std::vector<int> company{mover};
    for (std::size_t k = 0; k < company.size(); ++k) {
      const int i = company[k];
      if (i == other || !may_go(i, shift)) return {};
      const Pose pose = shifted(i, shift);
      for (const WorkPair& pair : work_.pairs) {
        if (!is_asked(pair, i)) continue;
        const int beside = pair.a == i ? pair.b : pair.a;
        if (std::find(company.begin(), company.end(), beside) != company.end()) continue;
        const bool is_in_way = !is_free_of(pair, i, pose);
        if (!is_in_way && (pair.has_sides || !is_in_one_place(pair) || is_apart(pair, i, pose))) continue;
        // What slides along something that stands still touches it as before.
        if (is_in_way || bodies_[at(beside)].is_dynamic()) company.push_back(beside);
      }
    }
    return company;
  }

  static bool is_in_one_place(const WorkPair& pair) {
    // What a joint holds has no contacts.
    return pair.least_gap <= kNoDistance * pair.size && (pair.joint >= 0 || !pair.contacts.empty());
  }

  // With the mover at that pose they are no longer in one place.
  bool is_apart(const WorkPair& pair, int mover, const Pose& pose) const {
    const int other = pair.a == mover ? pair.b : pair.a;
    const auto moved = collision::place_collider(*work_.bodies[at(mover)].collider, pose),
               still = collision::place_collider(*work_.bodies[at(other)].collider, bodies_[at(other)].pose);
    return !collision::are_within(moved, still, kNoDistance * pair.size);
  }

  bool is_asked(const WorkPair& pair, int mover) const {
    return (pair.a == mover || pair.b == mover) &&
           (!state_.pairs[at(pair.state)].is_exempt || is_touching(pair));
  }

  // It will be set aside, now or in the next round.
  bool is_touching(const WorkPair& pair) const {
    return std::find(touching_.begin(), touching_.end(), &pair) != touching_.end();
  }

  // At that pose the mover is not in the other of the pair, which stays where it is.
  bool is_free_of(const WorkPair& pair, int mover, const Pose& pose) const {
    const WorkBody& w = work_.bodies[at(mover)];
    const int number = pair.a == mover ? pair.b : pair.a;
    const WorkBody& other = work_.bodies[at(number)];
    const Pose& there = bodies_[at(number)].pose;
    Vec3 normal;
    if (pair.is_analytic) return collision::analytic_gap(*w.shape, pose, *other.shape, there, normal) >= 0.0;
    const collision::PlacedCollider placed = collision::place_collider(*w.collider, pose);
    // What crosses by rounding may go on doing so, but no deeper.
    if (state_.pairs[at(pair.state)].is_exempt) return !overlap(pair, mover, pose, 0.5 * aside(pair));
    if (!pair.is_plane)
      return !collision::crosses(placed, collision::place_collider(*other.collider, there)) &&
             !overlap(pair, mover, pose, kNoDistance * pair.size);
    normal = there.rotation * Vec3::UnitY();
    const auto is_above = [&](const Vec3& v) {
      return normal.dot(v - there.translation) >= w.collider->radius;
    };
    return std::all_of(placed.start.begin(), placed.start.end(), is_above);
  }

  bool is_free(int mover, const Pose& pose) const {
    return std::all_of(work_.pairs.begin(), work_.pairs.end(), [&](const WorkPair& pair) {
      return !is_asked(pair, mover) || is_free_of(pair, mover, pose);
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
      if (state_.pairs[at(pair.state)].is_exempt) return false;
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
  std::vector<const WorkPair*> touching_;
};

}  // namespace

bool part_coincident(std::vector<Body>& bodies, const ContactSettings& settings, ContactState& state,
                     const MotionWork& work, std::vector<std::pair<body::BodyId, body::BodyId>>& parted,
                     std::vector<body::BodyId>& moved) {
  return Parting(bodies, settings, state, work).run(parted, moved);
}

}  // namespace shatterbox::dynamics
