// Scratch of one step: bodies as the stages see them, pairs, contacts. Made anew every step; holds no state.
#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "engine/body/body.h"
#include "engine/body/impulse_log.h"
#include "engine/collision/contact.h"
#include "engine/collision/feature_gap.h"
#include "engine/core/vec.h"
#include "engine/dynamics/contact_settings.h"
#include "engine/dynamics/feature_search.h"
#include "engine/dynamics/free_motion.h"
#include "engine/dynamics/joint.h"
#include "engine/dynamics/rest.h"
#include "engine/geometry/bvh.h"

namespace shatterbox::dynamics {

// What sweeps over contacts touch comes first, in as few cache lines as it fits in.
struct alignas(64) WorkBody {
  Vec3 velocity = Vec3::Zero();         // m/s, now
  Vec3 spin = Vec3::Zero();             // rad/s, now
  double inverse_mass = 0.0;            // 1/kg; 0 for what this step cannot move: fixed, scripted, asleep
  double stirred = 0.0;                 // m/s: sum of all changes that the solver's impulses made
  Mat3 inverse_inertia = Mat3::Zero();  // world, now
  body::LockedAxes locked;
  double reach = 0.0;           // m: greatest distance of a vertex from the centre
  double travelled = 0.0;       // m, before this step
  Vec3 gravity = Vec3::Zero();  // m/s2, the body's own force with it; zero unless dynamic and awake

  const body::Shape* shape = nullptr;
  const collision::Collider* collider = nullptr;
  PrincipalInertia inertia;
  Vec3 inverse_moments = Vec3::Zero();  // about the principal axes; zero if nothing can turn it
  bool is_active = false;               // moves in this step: awake dynamic, or scripted with a velocity
  bool is_quiet = false;                // at the step's start
  bool may_break = false;
  bool is_struck = false;  // something arrives at it in this substep

  Pose start, end;
  Vec3 torque = Vec3::Zero();  // N m; zero unless dynamic and awake
  Vec3 velocity_start = Vec3::Zero(), spin_start = Vec3::Zero();
  double turn_angle = 0.0;          // rad, a bound of how far it turns in the step
  std::vector<Pose> substep_poses;  // after each substep of the solver
  int straight_parts = 1;           // of its way, a power of two: between them vertices go straight
  // Poses at equal times, start and end included; empty: a short turn. The centre goes straight in between.
  std::vector<Pose> knots;
  Vec3 way = Vec3::Zero();           // m, of the centre since the start
  Quat rotation = Quat::Identity();  // now
  Mat3 turn = Mat3::Identity();      // rotation since the start

  bool is_placed = false;
  bool is_free = true;               // no contact: end is where it goes by itself
  collision::PlacedCollider placed;  // vertices at the start
  // Everything that the body may meet is among the pairs if it ends within `reserve` of `looked_end`; one
  // that turns far, within the box.
  Pose looked_end;
  double reserve = 0.0;  // m
  bool is_looked_straight = true;
  geometry::Box looked;
  bool is_scripted = false;
  double gone = 1.0;  // share of its way that it was let go
  // Of a scripted one that moves, for each substep of the solver: its velocities in it, and where it is after
  // it against the start.
  struct Ride {
    Vec3 velocity = Vec3::Zero(), spin = Vec3::Zero();
    Vec3 way = Vec3::Zero();
    Quat turn = Quat::Identity();
  };
  std::vector<Ride> rides;
  Vec3 predicted_spin = Vec3::Zero();    // rad/s, then
  Pose predicted;                        // end pose if nothing new touches: who is borne does not fall
  Vec3 fall_left_out = Vec3::Zero();     // m: what was left out there, for it bore or was borne before
  std::vector<Vec3> predicted_vertices;  // |V| x 3, there; of bodies in a fast pair
  std::vector<Vec3> end_vertices;        // |V| x 3, at `end`, where that is being tested
};

/// A turn of more than this in a step, rad, is followed in parts: straight paths would cut its corner.
inline constexpr double kStraightTurn = 0.5;
inline bool turns_far(const WorkBody& body) {
  return body.turn_angle > kStraightTurn || body.straight_parts > 1;
}

/// What is no further apart, as a share of the pair's size, is in one place: there is no direction from one
/// to the other.
inline constexpr double kNoDistance = 1e-9;

/// What a contact gave over some time, as both bodies felt it.
struct GivenImpulse {
  Vec3 impulse_a = Vec3::Zero(), impulse_b = Vec3::Zero();  // N s, on a and b in their body spaces
  Vec3 moment_point = Vec3::Zero();                         // sum of |normal impulse| point
  Vec3 moment_a = Vec3::Zero(), moment_b = Vec3::Zero();    // the same in the body spaces of a and b
  double moment_weight = 0.0;

  bool is_any() const { return impulse_a.squaredNorm() > 0.0 && impulse_b.squaredNorm() > 0.0; }
  void add(const GivenImpulse& more);
};

/// What of it came by a hit.
struct ContactHit {
  Vec3 total = Vec3::Zero();  // N s, world, on a
  GivenImpulse given;
  double closing_speed = 0.0;   // m/s; 0: others of the pair arrived, or it did in the last step
  double arrival_time = 0.0;    // s since the step's start
  double effective_mass = 0.0;  // kg
};

// As above: what a visit of a sweep touches comes first, at the present pose.
struct alignas(64) SolverContact {
  int a = 0, b = 0;  // numbers of the bodies
  int pair = 0;
  int row = 0;             // of the pair in the solver of its island
  bool has_sides = false;  // one of the two is solid
  bool is_close = false;   // both are, and were placed nearer than the usual gap
  bool can_creep = false;  // both are quiet, and no sphere rolls
  bool is_arriving = false;
  bool has_response = false;  // `response` and `weights` are those of the present pose
  double slack = 0.0;         // m: gap less kept gap
  Vec3 normal = Vec3::UnitY();
  Vec3 impulse = Vec3::Zero();  // of this substep, in (normal, tangents), N s
  Vec3 arm_a = Vec3::Zero(), arm_b = Vec3::Zero();
  Vec3 tangent_u = Vec3::UnitX(), tangent_v = Vec3::UnitZ();
  Mat3 response = Mat3::Zero();  // relative velocity by impulse, in (normal, tangents), 1/kg
  Vec3 weights = Vec3::Zero();   // 1 / diagonal of it, kg
  double friction = 0.0, rolling = 0.0;
  double kept_gap = 0.0;      // m
  double threshold = 0.0;     // m/s: slower closing does not bounce
  Vec3 total = Vec3::Zero();  // N s, world, on a, of the whole step
  double left_over = 0.0;     // m/s, along the normal, that the last visit's friction brought
  Vec3 warm = Vec3::Zero();   // to start the next substep from, in the axes of `impulse`
  // N s along the normal in a substep: many times what the lighter body weighs. What is left at such a
  // contact is felt far away.
  double strained_from = 0.0;
  Vec3 change = Vec3::Zero();     // m: of a against b since the step's start
  Vec3 held_from = Vec3::Zero();  // m: `change` where friction began to hold
  double target = 0.0;            // m/s, of the bounce
  double jammed_at = -1.0;        // N s along the normal where sweeps ran away: friction is bounded by it

  Vec3 point = Vec3::Zero();
  double restitution = 0.0;
  bool was_loaded = false;             // in the last step
  bool was_apart = false;              // at the start of the part of a substep that is taken
  collision::Contact found;            // at the start of the step
  Vec3 tangent_start = Vec3::UnitX();  // unit, across `found.normal`
  Vec3 arm_a_start = Vec3::Zero(), arm_b_start = Vec3::Zero();  // m
  Vec3 rolling_impulse = Vec3::Zero();                          // couple, N m s, in the axes of `impulse`
  Vec3 creep_before = Vec3::Zero();                             // m, at the start of the step
  Vec3 warm_start = Vec3::Zero();                               // of the last step, to begin this one with
  double arrival_speed = 0.0;                                   // m/s, of an impact that has not bounced
  double arrival_before = 0.0;                                  // m/s, the same at the start of the step

  // Of the whole step, less its hits.
  GivenImpulse given;
  bool tells_hits = false;       // something may break: what arrived is in `hits`
  std::vector<ContactHit> hits;  // by time
  double hit_left = 0.0;         // s: how long the last one goes on yet,
  double hit_left_before = 0.0;  // and that of the last step at this one's start
  double closing_speed = 0.0;    // m/s, greatest of an arrival
  double arrival_time = 0.0;     // s since the step's start, of the first arrival
  double effective_mass = 0.0;   // kg, at that arrival
};

struct WorkPair {
  int a = 0, b = 0;  // numbers of the bodies, a < b
  int state = 0;     // number in ContactState::pairs
  PairMaterial material;
  double size = 0.0;         // m
  double rounding = 0.0;     // m, of gaps where the bodies are
  double kept_gap = 0.0;     // m, after adaptation
  double threshold = 0.0;    // m/s
  bool is_plane = false;     // b is the plane
  bool is_flipped = false;   // the plane has the lower number
  bool is_analytic = false;  // spheres and boxes
  bool has_sides = false;    // the gap has a sign: a plane, two solids, or a sphere and a surface
  bool is_close = false;     // two solids that were placed nearer than the usual gap
  bool is_fast = false;      // moves further than a feature list is good for
  bool looks_ahead = false;  // may go so far that what it will meet is looked for on the predicted ways
  bool needs_search = false;
  bool passes = false;             // crosses since it was first seen, and there is no side to part to
  int joint = -1;                  // that holds them together: what they give each other is its; -1: none
  bool is_first_seen = false;      // no memory of it, or one of its bodies was put where it is
  double motion = 0.0;             // m: bound of the relative motion if nothing touches
  double margin = 0.0;             // m: contacts are felt from this gap on
  double clear = -1e300;           // m: its surfaces start at least so far apart, as far as is known
  double clearance = -1e300;       // m: the predicted ways stay at least so far apart
  bool is_apart = false;           // further than the margin: nothing more need be known
  double beyond = -1e300;          // m: features that its search does not list start further apart
  bool is_free_certified = false;  // the predicted paths of both bodies are known to be free
  std::shared_ptr<const FeatureSearch> search;
  PathMemory known;          // of its features
  double least_gap = 1e300;  // m, at the start; at least what was looked at if nothing is near
  std::vector<collision::Contact> contacts;
  int former = -1;   // row of the part's former taking, which began alike for it; -1: none
  int earlier = -1;  // number in an earlier round of this taking, which began alike for it; -1: none
};

struct WorkJoint {
  int a = 0, b = 0;  // numbers of the bodies
  int state = 0;     // number in ContactState::joints
  const Joint* joint = nullptr;

  // At the present pose: one point for both bodies, and the axes of a's frame.
  Vec3 point = Vec3::Zero(), arm_a = Vec3::Zero(), arm_b = Vec3::Zero();
  Mat3 axes = Mat3::Identity();
  Vec3 off = Vec3::Zero(), off_turn = Vec3::Zero();          // m, rad, of b against a
  Vec3 closing = Vec3::Zero(), closing_turn = Vec3::Zero();  // m/s, rad/s of a against b before the drift
  // N s by m/s, and N m s by rad/s; of a square metre of the first kind.
  double stiffness = 0.0, linear_stiffness = 0.0;
  Mat3 turn_stiffness = Mat3::Zero();

  Vec3 given = Vec3::Zero(), given_couple = Vec3::Zero();  // N s, N m s on a in this substep, world
  Vec3 lent = Vec3::Zero(), lent_couple = Vec3::Zero();    // the same, for the drift only
  // Of the whole step: in the joint's axes as they were, and in the world's.
  Vec3 total = Vec3::Zero(), total_couple = Vec3::Zero();
  Vec3 total_world = Vec3::Zero(), total_couple_world = Vec3::Zero();
  Vec3 blow = Vec3::Zero(), blow_couple = Vec3::Zero();  // of the first, what answers arrivals alone
  bool is_struck = false;
  double most = 0.0;  // N s, of a substep
};

struct Island {
  std::vector<int> bodies;    // dynamic ones, ascending
  std::vector<int> contacts;  // ascending
  std::vector<int> joints;    // ascending
  bool may_break = false;     // one of its bodies, what holds them still included, or a joint

  // It has so many contacts that few sweeps a substep must do.
  bool is_large() const { return contacts.size() > kLarge; }
  static constexpr std::size_t kLarge = 1200;
};

class MotionWork {
 public:
  std::vector<WorkBody> bodies;  // as many as the world's, same order
  std::vector<WorkPair> pairs;   // ascending; behind them those that were missed, as they were found
  std::vector<std::pair<int, int>> missed_pairs;  // these, ascending
  std::vector<SolverContact> contacts;
  std::vector<WorkJoint> joints;
  std::vector<std::pair<std::pair<int, int>, int>> joined;  // pairs of bodies, and the joint over an area
  std::vector<std::pair<int, int>> pivots;                  // pairs about a point; both ascending
  std::vector<Island> islands;
  std::vector<Disturbance> to_wake;     // sleepers that something comes down on
  std::vector<body::BodyId> to_strike;  // scripted ones that come upon what can break and cannot give way
  std::vector<body::BodyId> ids;
  std::vector<char> is_new;         // per body: new, reshaped, or moved by hand since the last step
  body::ImpulseLog continuous_log;  // impulses of the continuous pass
  int failsafe_bodies = 0;
  bool has_scripted = false;     // ones that move
  bool is_solved_again = false;  // islands are, with what met on its way
  bool is_trial = false;         // ways that are not free are left so
  bool is_shortest = false;      // no part is shorter than this one
  double substep = 0.0;          // s
  double warm_scale = 1.0;       // of remembered impulses: this step's substep over the last one's

  bool has_pair(int a, int b) const;
};

/// Lets go of what pairs hold, on all threads: there is a list of every feature that is near.
void free_pairs(MotionWork& work);

/// kg m2, world, of a body that has turned to `rotation`.
Mat3 inertia_at(const WorkBody& body, const Quat& rotation);

/// J, of a body that can be moved and has turned to `rotation`.
double kinetic_energy(const WorkBody& body, const Quat& rotation, const Vec3& velocity, const Vec3& spin);

/// 1/(kg m2), world: spin by angular impulse of a body that has turned to `rotation`.
Mat3 inverse_inertia_at(const WorkBody& body, const Quat& rotation);

/// Turns a dynamic body that nothing touches for `time` (s): its torque acts in two halves, before and after.
void advance_turning(const WorkBody& body, double time, Quat& rotation, Vec3& spin);

/// Fills a body's vertices at the start of the step, once.
void place(WorkBody& body);

/// The same with the boxes over them.
void place_in_boxes(WorkBody& body);

/// Vertices (|V| x 3, world) at a pose.
void place_at(const WorkBody& body, const Pose& pose, std::vector<Vec3>& out);

/// Which way a separates from b where features touch: out of the solid one, or from centre to centre.
Vec3 direction_hint(const WorkBody& a, const WorkBody& b, const collision::FeaturePoints& points);

/// Where a point on the surface of the body goes that is at `point` when the body is at `from`, when it is at
/// `to`: with its material, but on a sphere with its direction.
Vec3 carry(const WorkBody& body, const Vec3& point, const Pose& from, const Pose& to);

/// Between two poses: straight, and turning the short way.
Pose blend(const Pose& from, const Pose& to, double time);

/// Where the body is after the share `time` of the step.
Pose pose_on_way(const WorkBody& body, double time);

/// How far the centre strays at most, on its way over the knots, from the straight line to its end, m.
double find_bow(const WorkBody& body);

/// Whether it ends just where it is predicted to.
inline bool goes_as_predicted(const WorkBody& body) {
  return body.is_free && body.fall_left_out.isZero(0.0);
}

/// A bound of how far it turns in the step if nothing touches it, rad.
double free_turn_angle(const WorkBody& body, double time_step);

/// Straight parts in which a turn of so much (rad) must be followed: a power of two, so that the parts of two
/// bodies fit into each other.
int count_straight_parts(double turn_angle);

/// Gives the end another rotation, not by an impulse: the spin turns along, so that the body keeps its
/// energy. A sphere's stays as it is; of what has locked axes only what these let through, and no more
/// energy.
void turn_end(WorkBody& body, const Quat& rotation);

/// Moves the end pose by `shift` (m) and `turn` (rotation vector), and the way to it in proportion.
void shift_end(WorkBody& body, const Vec3& shift, const Vec3& turn);

/// Lets the body go only this share of its way.
void shorten(WorkBody& body, double share);

/// The straight way of a body's vertices from where they are at one pose to where they are at another, or
/// between two shares of that.
collision::BodyWay straight_way(const WorkBody& body, const Pose& from, const Pose& to, double begin = 0.0,
                                double end = 1.0);

/// Two that are `apart` and go straight, `way` against each other, come no closer than this, m.
double closest_approach(const Vec3& apart, const Vec3& way);

/// Two bodies, one of which turns far, surely stay so far apart, m: the one within a ball, and both, if that
/// tells that they keep more than is `wanted`. Those that do not turn far must be placed in boxes.
double clearance_of_balls(const WorkBody& a, const Pose& end_a, const WorkBody& b, const Pose& end_b,
                          double wanted);

/// No point of the body moves further than this by its turn from start to `end`, m.
double turn_bound(const WorkBody& body, const Pose& end);

/// All features of a pair that come within `margin` on the way to these ends. Both bodies must be placed in
/// boxes.
std::shared_ptr<const FeatureSearch> search_paths(const WorkBody& a, const Pose& end_a, const WorkBody& b,
                                                  const Pose& end_b, double margin);

/// No point of the body is further from where it started than this at `end`, m.
double travelled_at_most(const WorkBody& body, const Pose& end);

/// Relative motion of a pair during the step is at most this, m: from ways and turns of end poses.
double motion_bound(const WorkBody& a, const Pose& end_a, const WorkBody& b, const Pose& end_b);

}  // namespace shatterbox::dynamics
