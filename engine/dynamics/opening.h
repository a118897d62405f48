// Opens gaps again in position: what would touch on the way is pushed apart at the end poses, together with
// the contacts of the bodies in it. Velocities only lose approach, so that no energy comes in.
#pragma once

#include <optional>
#include <vector>

#include "engine/collision/contact.h"
#include "engine/dynamics/motion_work.h"

namespace shatterbox::dynamics {

/// One constraint of the local solve on end poses.
struct Opening {
  int a = 0, b = 0;           // numbers of the bodies
  Vec3 normal, arm_a, arm_b;  // arms from the centres where it acts, m
  double share = 1.0;         // of the step at which it acts: the end pose moves its place by so much less
  double gap = 0.0;           // m, there
  double wanted = 0.0;        // m
  double weight = 0.0;        // kg
  double impulse = 0.0;       // kg m, of the displacement
  bool bounces = false;       // a hit that nobody solved: what closes there is turned round
  bool is_joined = false;     // only the places are mended: what is given is the joint's
  double restitution = 0.0;   // by as much, if it closes faster than
  double threshold = 0.0;     // this, m/s
};

/// Who gives way: the lighter by its mass, or all as if their masses were one.
enum class Yielding { by_mass, alike };

/// What moves as a whole while gaps are opened: a body, or several that go as one.
struct Mover {
  double inverse_mass = 0.0;  // 1/kg; 0 for what does not move
  body::LockedAxes locked;
  Mat3 inverse_inertia = Mat3::Zero();  // world
};

/// By how much each mover was moved.
struct Moves {
  std::vector<Vec3> shifts, turns;  // m; rotation vectors about the centre of mass, rad
};

/// The constraint of a contact that was seen from the start, at the share `knot` of the step: surfaces go on
/// as planes, but where features would be in each other's way so and are not, because they pass each other
/// by, it is that of their places at the ends.
Opening make_opening(const WorkPair& pair, const MotionWork& work, const collision::Contact& contact,
                     double knot, double wanted);

/// The gap of a contact at the share `knot` of the step, along its normal, m.
double gap_on_way(const WorkPair& pair, const MotionWork& work, const collision::Contact& contact,
                  double knot);

/// kg: one over the response of the gap to an impulse on it; 0 if nothing can move. The arms of the opening
/// are those of the movers.
double opening_weight(const Opening& opening, const Mover& a, const Mover& b, Yielding yielding);

/// Finds moves after which the gaps are as wanted, as far as that goes, and the impulses that make them. `a`,
/// `b`, the arms and the weights (by mass) of the openings are those of movers.
Moves relax(std::vector<Opening>& openings, const std::vector<Mover>& movers, Yielding yielding);

/// By how much a body's end was moved: its centre by `shift`, its points by `turned` more at most, m.
struct EndMove {
  Vec3 shift = Vec3::Zero();
  double turned = 0.0;

  bool is_none() const { return turned == 0.0 && shift.isZero(0.0); }
};

/// No points of two bodies were moved further against each other, m.
double move_between(const EndMove& a, const EndMove& b);

/// Moves a body's end pose.
EndMove move_end(WorkBody& body, const Vec3& shift, const Vec3& turn);

/// Moves end poses until the gaps are as wanted, as far as that goes; takes away the approach of those that
/// pushed and logs it: by no more than what opened them if they yield by mass. Returns by how much each
/// body was moved.
std::vector<EndMove> open_gaps(std::vector<Opening>& openings, double time_step, Yielding yielding,
                               MotionWork& work);

/// Removes what closes along these constraints by impulses between the pairs, or turns it round by their
/// restitution, `sweeps` times over, and logs them as `kind`. With a time step (s) each is at most what the
/// opening took over it, unless it bounces.
void remove_approach(const std::vector<Opening>& openings, std::optional<double> time_step,
                     body::ImpulseKind kind, int sweeps, MotionWork& work);

}  // namespace shatterbox::dynamics
