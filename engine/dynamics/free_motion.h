// A rigid body that nothing touches: the parabola, and the torque-free spin by splitting into rotations about
// the principal axes (each an exact flow; angular momentum is kept to rounding, energy without drift),
// composed to fourth order by Suzuki's scheme.
#pragma once

#include "engine/body/locked_axes.h"
#include "engine/core/vec.h"

namespace shatterbox::dynamics {

/// Principal moments and axes of a body.
struct PrincipalInertia {
  Vec3 moments = Vec3::Ones();  // kg m2, positive
  Quat body_from_axes = Quat::Identity();
  bool is_round = false;  // all moments equal: the spin is constant
};

/// Of an inertia tensor (body space, kg m2). Moments that vanish beside the greatest are raised to 1e-12 of
/// it.
PrincipalInertia find_principal_inertia(const Mat3& inertia);

enum class SpinOrder { second, fourth };

/// Turns a torque-free body for `time` seconds: `rotation` is world from body, `spin` its angular velocity
/// (world, rad/s). Divided so that no part turns by more than a twentieth of a radian.
void advance_spin(const PrincipalInertia& inertia, double time, SpinOrder order, Quat& rotation, Vec3& spin);

/// The same of a body that may not turn about some axes, nor does at the start: the momentum about the others
/// is kept to rounding, the energy to fourth order (Munthe-Kaas' Runge-Kutta scheme; without error about one
/// axis).
void advance_locked_spin(const PrincipalInertia& inertia, const body::LockedAxes& locked, double time,
                         Quat& rotation, Vec3& spin);

/// Either of them.
void advance_turn(const PrincipalInertia& inertia, const body::LockedAxes& locked, double time,
                  SpinOrder order, Quat& rotation, Vec3& spin);

/// Rotation by a rotation vector (rad).
Quat rotation_by(const Vec3& rotation_vector);

/// The rotation vector (rad) that leads from one to the other the short way.
Vec3 turn_between(const Quat& from, const Quat& to);

}  // namespace shatterbox::dynamics
