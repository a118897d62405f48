#include "engine/dynamics/joint_work.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "engine/core/index.h"

namespace shatterbox::dynamics {
namespace {

using core::at;

int find_number(const MotionWork& work, body::BodyId id) {
  const auto place = std::lower_bound(work.ids.begin(), work.ids.end(), id);
  return place != work.ids.end() && *place == id ? static_cast<int>(place - work.ids.begin()) : -1;
}

std::pair<int, int> ordered(int a, int b) {
  return {std::min(a, b), std::max(a, b)};
}

// By how much a body that a couple across `arm` turns can turn at most, 1/(kg m2).
double yield_across(const WorkBody& body, const Vec3& arm) {
  const Vec3 u = arm.unitOrthogonal(), v = arm.normalized().cross(u);
  const double uu = u.dot(body.inverse_inertia * u), vv = v.dot(body.inverse_inertia * v);
  const double uv = u.dot(body.inverse_inertia * v), half = 0.5 * (uu - vv);
  return 0.5 * (uu + vv) + std::sqrt(half * half + uv * uv);
}

// rad/s: a link that is pulled at both ends swings about its centre as a pendulum does, the faster the harder
// it is pulled.
double find_swing(const MotionWork& work) {
  std::map<int, double> squares;  // of each body's
  for (const WorkJoint& joint : work.joints) {
    if (!joint.joint->is_pivot) continue;
    const double force = joint.most / work.substep;
    const auto pull = [&](int number, const Vec3& arm) {
      const WorkBody& body = work.bodies[at(number)];
      if (body.inverse_mass == 0.0 || arm.isZero(0.0)) return;
      squares[number] += force * arm.norm() * yield_across(body, arm);
    };
    pull(joint.a, joint.arm_a);
    pull(joint.b, joint.arm_b);
  }
  double most = 0.0;
  for (const auto& [number, square] : squares) most = std::max(most, square);
  return std::sqrt(most);
}

}  // namespace

void add_to_hash(const std::vector<Joint>& joints, core::Hash& hash) {
  for (const Joint& joint : joints) {
    hash.add(static_cast<std::uint64_t>(joint.number));
    hash.add((static_cast<std::uint64_t>(joint.body_a) << 32) | joint.body_b);
    hash.add(std::uint64_t{joint.may_meet}).add(joint.impulse).add(joint.couple);
  }
}

void list_joints(const ContactState& state, MotionWork& work) {
  for (std::size_t k = 0; k < state.joints.size(); ++k) {
    const Joint& joint = state.joints[k];
    WorkJoint w;
    w.a = find_number(work, joint.body_a);
    w.b = find_number(work, joint.body_b);
    if (w.a < 0 || w.b < 0) continue;
    if (work.bodies[at(w.a)].inverse_mass == 0.0 && work.bodies[at(w.b)].inverse_mass == 0.0) continue;
    w.state = static_cast<int>(k);
    w.joint = &joint;
    work.joints.push_back(w);
    if (joint.may_meet) continue;
    if (joint.is_pivot)
      work.pivots.push_back(ordered(w.a, w.b));
    else
      work.joined.emplace_back(ordered(w.a, w.b), static_cast<int>(work.joints.size()) - 1);
  }
  std::sort(work.pivots.begin(), work.pivots.end());
  std::sort(work.joined.begin(), work.joined.end());
}

bool share_pivot(const MotionWork& work, int a, int b) {
  return !work.pivots.empty() && std::binary_search(work.pivots.begin(), work.pivots.end(), ordered(a, b));
}

void forget_joined_contacts(MotionWork& work) {
  if (work.joined.empty()) return;
  for (WorkPair& pair : work.pairs) {
    const std::pair key(ordered(pair.a, pair.b), 0);
    const auto joined = std::lower_bound(work.joined.begin(), work.joined.end(), key);
    if (joined == work.joined.end() || joined->first != key.first) continue;
    pair.contacts.clear();
    pair.joint = joined->second;
  }
}

double off_at_end(const WorkJoint& joint, const MotionWork& work) {
  const WorkBody &a = work.bodies[at(joint.a)], &b = work.bodies[at(joint.b)];
  const Pose &in_a = joint.joint->frame_a, &in_b = joint.joint->frame_b;
  return (b.end.apply(in_b.translation) - a.end.apply(in_a.translation)).norm() +
         turn_bound(a.end.rotation * in_a.rotation, b.end.rotation * in_b.rotation,
                    std::min(a.reach, b.reach));
}

core::DisjointSets join_bodies(const MotionWork& work) {
  core::DisjointSets joined(work.bodies.size());
  for (const WorkJoint& joint : work.joints) {
    if (joint.joint->is_pivot) continue;
    if (work.bodies[at(joint.a)].inverse_mass > 0.0 && work.bodies[at(joint.b)].inverse_mass > 0.0)
      joined.unite(joint.a, joint.b);
  }
  return joined;
}

void log_joints(const MotionWork& work, body::ImpulseLog& log) {
  for (const WorkJoint& w : work.joints) {
    if (w.total_world.squaredNorm() + w.total_couple_world.squaredNorm() == 0.0) continue;
    const WorkBody &a = work.bodies[at(w.a)], &b = work.bodies[at(w.b)];
    const Mat3 axes = (a.end.rotation * w.joint->frame_a.rotation).toRotationMatrix();
    const Vec3 force = axes.transpose() * w.total_world, couple = axes.transpose() * w.total_couple_world;
    const auto give = [&](const Vec3& offset, const Vec3& impulse) {
      body::LoggedImpulse entry =
          body::log_impulse(body::ImpulseKind::contact, work.ids[at(w.a)], a.end, work.ids[at(w.b)], b.end,
                            w.point + axes * offset, axes.col(0), axes * impulse);
      const double inverse_mass = a.inverse_mass + b.inverse_mass;
      entry.effective_mass = 1.0 / inverse_mass;
      log.push_back(entry);
    };
    if (w.joint->is_pivot) {
      give(Vec3::Zero(), force);
      continue;
    }
    const double half_y = std::sqrt(w.joint->moments.z() / w.joint->area);
    const double half_z = std::sqrt(w.joint->moments.y() / w.joint->area);
    const double square = half_y * half_y + half_z * half_z;
    for (const double side_y : {-1.0, 1.0}) {
      for (const double side_z : {-1.0, 1.0}) {
        const Vec3 offset(0.0, side_y * half_y, side_z * half_z);
        Vec3 impulse = 0.25 * force;
        impulse.x() += 0.25 * (couple.y() * side_z / half_z - couple.z() * side_y / half_y);
        impulse += 0.25 * couple.x() / square * Vec3::UnitX().cross(offset);
        give(offset, impulse);
      }
    }
  }
}

void remember_joints(const MotionWork& work, ContactState& state) {
  for (Joint& joint : state.joints) {
    joint.impulse = joint.couple = joint.blow_impulse = joint.blow_couple = Vec3::Zero();
    joint.is_struck = false;
  }
  for (const WorkJoint& w : work.joints) {
    Joint& joint = state.joints[at(w.state)];
    joint.impulse = w.total;
    joint.couple = w.total_couple;
    joint.blow_impulse = w.blow;
    joint.blow_couple = w.blow_couple;
    joint.is_struck = w.is_struck;
  }
  state.swing = find_swing(work);
}

double find_swing_by_blows(const std::vector<body::Body>& bodies, const MotionWork& work, double time_step) {
  if (work.joints.empty()) return 0.0;
  std::vector<char> is_link(bodies.size(), 0);
  for (const WorkJoint& joint : work.joints)
    if (joint.joint->is_pivot) is_link[at(joint.a)] = is_link[at(joint.b)] = 1;
  const auto mobility_of = [&](int number, const Vec3& place, const Vec3& direction) {
    const body::Body& body = bodies[at(number)];
    return body.mobility(body.pose.apply_inverse(place), body.pose.rotation.conjugate() * direction);
  };
  double most = 0.0;
  for (const WorkPair& pair : work.pairs) {
    if (!is_link[at(pair.a)] && !is_link[at(pair.b)]) continue;
    const WorkBody &a = work.bodies[at(pair.a)], &b = work.bodies[at(pair.b)];
    for (const collision::Contact& c : pair.contacts) {
      const double speed = -c.normal.dot(a.velocity + a.spin.cross(c.on_a - a.start.translation) -
                                         b.velocity - b.spin.cross(c.on_b - b.start.translation));
      if (speed <= pair.threshold || speed * time_step <= c.gap) continue;
      const double of_a = mobility_of(pair.a, c.on_a, c.normal), of_b = mobility_of(pair.b, c.on_b, c.normal);
      if (is_link[at(pair.a)]) most = std::max(most, speed * of_a / (of_a + of_b) / a.reach);
      if (is_link[at(pair.b)]) most = std::max(most, speed * of_b / (of_a + of_b) / b.reach);
    }
  }
  return most;
}

double find_torn(const MotionWork& work) {
  double most = 0.0;
  for (const WorkJoint& joint : work.joints) {
    const WorkBody &a = work.bodies[at(joint.a)], &b = work.bodies[at(joint.b)];
    const Vec3 off =
        b.end.apply(joint.joint->frame_b.translation) - a.end.apply(joint.joint->frame_a.translation);
    most = std::max(most, off.norm() / std::min(a.reach, b.reach));
  }
  return most;
}

}  // namespace shatterbox::dynamics
