#include "engine/dynamics/contact_friction.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace shatterbox::dynamics {
namespace {

constexpr double kMostBack = 0.1;     // of the kept gap: creep beyond it does not count
constexpr double kPatch = 2.0 / 3.0;  // mean arm of friction over a patch, of its radius

}  // namespace

void slide_on(SolverContact& c) {
  const Vec3 crept = c.change - c.held_from;
  const double length = crept.norm(), most = kMostBack * c.kept_gap;
  if (length > most) c.held_from = c.change - crept * (most / length);
}

Vec2 way_back(const SolverContact& c, double step) {
  if (!c.can_creep) return Vec2::Zero();
  const Vec3 crept = c.change - c.held_from;
  Vec2 back(c.tangent_u.dot(crept), c.tangent_v.dot(crept));
  const double length = back.norm(), most = kMostBack * c.kept_gap;
  back *= 0.2 / step;
  return length > most ? Vec2(back * (most / length)) : back;
}

double friction_bound(const SolverContact& c, double normal_impulse) {
  return c.friction * (c.jammed_at < 0.0 ? normal_impulse : c.jammed_at);
}

Vec2 friction_change(const SolverContact& c, const Vec2& slip, double normal_impulse) {
  if (c.friction <= 0.0) return Vec2::Zero();
  const double bound = friction_bound(c, normal_impulse);
  const Vec2 held(c.impulse[1], c.impulse[2]);
  const double kuu = c.response(1, 1), kvv = c.response(2, 2), kuv = c.response(1, 2);
  Vec2 wanted =
      held - Vec2(kvv * slip[0] - kuv * slip[1], kuu * slip[1] - kuv * slip[0]) / (kuu * kvv - kuv * kuv);
  if (wanted.squaredNorm() > bound * bound) {
    // It slides: friction is against the slip, whatever the body's own directions.
    wanted = held - slip * (2.0 / (kuu + kvv));
    const double length = wanted.norm();
    if (length > bound) wanted *= bound / length;
  }
  return wanted - held;
}

void resist_rolling(SolverContact& c, WorkBody& a, WorkBody& b) {
  if (c.rolling <= 0.0 || c.impulse[0] <= 0.0) return;
  const Vec3 axes[3] = {c.normal, c.tangent_u, c.tangent_v};
  Mat3 yielding = Mat3::Zero();
  for (const WorkBody* w : {&a, &b})
    if (w->inverse_mass > 0.0) yielding += w->inverse_inertia;
  Mat3 response;
  Vec3 spin;
  for (int l = 0; l < 3; ++l) {
    spin[l] = axes[l].dot(a.spin - b.spin);
    const Vec3 turn = yielding * axes[l];
    for (int k = 0; k < 3; ++k) response(k, l) = axes[k].dot(turn);
  }
  const double trace = response.trace();
  if (trace <= 0.0) return;
  // About axes that are locked nothing yields: what turns about them meets what rolling can resist.
  if (a.locked.any() || b.locked.any()) response.diagonal().array() += body::kLeastYield * trace;
  const double bound = c.rolling * c.impulse[0], twist = kPatch * c.friction * bound;
  const auto is_borne = [&](const Vec3& couple) {
    return std::abs(couple[0]) <= twist && couple.tail<2>().squaredNorm() <= bound * bound;
  };
  Vec3 wanted = c.rolling_impulse - response.inverse() * spin;
  if (!is_borne(wanted)) {
    // It rolls on: a step against the spin that no slender body overshoots, whichever way it lies.
    wanted = c.rolling_impulse - spin / trace;
    wanted[0] = std::clamp(wanted[0], -twist, twist);
    if (const double length = wanted.tail<2>().norm(); length > bound) wanted.tail<2>() *= bound / length;
  }
  const Vec3 change = wanted - c.rolling_impulse;
  const Vec3 couple = change[0] * axes[0] + change[1] * axes[1] + change[2] * axes[2];
  for (WorkBody* w : {&a, &b}) {
    if (w->inverse_mass <= 0.0) continue;
    const Vec3 turn = w->inverse_inertia * couple;
    w->spin += w == &a ? turn : Vec3(-turn);
    w->stirred += w->reach * turn.lpNorm<1>();
  }
  c.rolling_impulse = wanted;
}

}  // namespace shatterbox::dynamics
