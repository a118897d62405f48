// From the impulse log to the loads on one body: impulses of a step gathered by place, and their sums over an
// event. [BHTF07] sec. VI sums the impulses of a step; departs from it because collisions are summed over an
// impact event and contact is averaged over a fixed time, so that the step size does not matter.
#pragma once

#include <functional>
#include <memory>
#include <variant>
#include <vector>

#include "engine/body/body.h"
#include "engine/body/impulse_log.h"
#include "engine/fracture/shell_dent.h"
#include "engine/fracture/solid_dent.h"
#include "engine/stress/contact_duration.h"

namespace shatterbox::world {

/// Impulses on one body by one other body about one place.
struct Load {
  body::BodyId other = 0;
  Vec3 point_body = Vec3::Zero();     // m, body space of the struck body
  Vec3 impulse_body = Vec3::Zero();   // N s, on the struck body, its body space
  Vec3 other_point = Vec3::Zero();    // m, the same point in the body space of the other
  Vec3 other_impulse = Vec3::Zero();  // N s, on the other, its body space
  Vec3 point_world = Vec3::Zero();    // m, when it happened
  double closing_speed = 0.0;         // m/s, greatest of the gathered collisions
  double first_time = 0.0;            // s, of the first impulse
  double time = 0.0;                  // s, of the last one
  double duration = 0.0;              // s, of a blast; 0: that of the impact
  double spread = 0.0;                // m, radius of the disc over which a blast came
  bool was_asked = false;             // it is known that the other does not perforate: it lacks the energy
};

/// What an impact leaves when it is over.
struct ComingDent {
  std::variant<std::shared_ptr<const fracture::SolidDent>, std::shared_ptr<const fracture::ShellDent>> dent;
  double von_mises = 0.0, yield = 0.0;  // Pa
  Vec3 place = Vec3::Zero();            // m, material space: of the hit
  double not_before = -1e9;             // s: until then striker and plug are in the hole; a step later

  /// Null of the other kind.
  const fracture::SolidDent* solid() const { return find<fracture::SolidDent>(); }
  const fracture::ShellDent* shell() const { return find<fracture::ShellDent>(); }
  const fracture::DentFigures& figures() const {
    return std::visit([](const auto& d) -> const fracture::DentFigures& { return *d; }, dent);
  }

 private:
  template <class Dent>
  const Dent* find() const {
    const auto* own = std::get_if<std::shared_ptr<const Dent>>(&dent);
    return own ? own->get() : nullptr;
  }
};

/// What a fragile body remembers of its impacts between steps. Part of the state.
struct ImpactMemory {
  std::vector<Load> event;        // collision sums of the event that is under way
  double event_duration = 0.0;    // s, the longest that its impact was evaluated with
  std::vector<Load> contact;      // contact impulses of the last 1/60 s, one entry a step and place
  std::vector<ComingDent> dents;  // of events that are over; the last one of `event`, as last evaluated, if
  bool has_open_dent = false;     // that is so
  double tested_contact = 0.0;    // N: total contact force at which the body was last found to hold
  double tested_growth = 1.1;     // times that force, at which it is tested again
  double solved_contact = 0.0;    // N: that force when a solve last told that the body holds; 0: none has
  double solved_ratio = 0.0;      // stress over strength, as it told, with what struck
  double torn_until = -1e9;       // s: an event that began by then has torn
  bool keeps_dents = true;        // false of a piece of what cracked, which tears
  int generation = 0;             // breaks since the event began from which this piece comes

  /// s, when a break made this piece, or cracks what it is by now: what presses on that is known on average
  /// only contact_average later.
  double born = -1e9;

  // The impact that made this piece was charged with its whole impulse when it was judged. Until it is over,
  // what comes from another piece of the same break is part of it, and so is, up to that impulse, what comes
  // from the same body: what is beyond it is charged.
  double charged_until = -1e9;     // s
  double charged_left = 0.0;       // N s
  body::BodyId charged_other = 0;  // whom the broken body had met
  body::BodyId charged_event = 0;  // the body that broke
};

/// The time over which contact impulses are averaged, s; in whole steps of `step` s, at least one.
inline constexpr double kContactAverage = 1.0 / 60.0;
double contact_average(double step);

/// Takes from the load what was charged with the impact that made the piece, from whose `charged_left` it
/// goes; `other_memory`, of the load's other body, may be null. True if nothing is left of the load.
bool take_charged(ImpactMemory& piece, const ImpactMemory* other_memory, Load& load);

/// True if the load comes from a piece of the same body that still sits beside this one: the place where they
/// press is the same one in their common material space, but for the shape's seat (of shells a thickness).
/// Such pieces push with their whole crack faces, along the shell, where nothing bends; what passes through a
/// piece to its neighbours in this way does not load it.
bool is_seated(const body::Body& struck, const body::Body& other, const Load& load);

/// Takes from `loads` (collisions of a step) what goes on to seated neighbours, which push with `passed_on`
/// (N s, sum, body space): what is left is the piece's own share.
void keep_own_share(std::vector<Load>& loads, const Vec3& passed_on);

/// Whether an impulse is to be passed over; it may be lessened.
using PassOver = std::function<bool(Load& load)>;

/// What a log says of one body, in the log's order.
using OwnImpulses = std::vector<const body::LoggedImpulse*>;

/// For each body of `ids` (ascending) what `log` says of it. The log must outlive the answer.
std::vector<OwnImpulses> sort_by_body(const body::ImpulseLog& log, const std::vector<body::BodyId>& ids);

/// Loads of one kind of one step on `struck`, which began at `step_start` (s), gathered: same other body,
/// nearer than `radius` (m), similar direction.
std::vector<Load> gather_loads(const OwnImpulses& impulses, body::ImpulseKind kind, const body::Body& struck,
                               double radius, double step_start, const PassOver& pass_over = {});

/// Adds `loads` to the sums in `event`, at the place of a load that is already there.
void add_to_event(std::vector<Load>& event, const std::vector<Load>& loads, double radius);

/// Hertz's contact of a body with another one, which may be null: of no elasticity known.
stress::HertzContact find_hertz_contact(const body::Body& struck, const body::Body* other);

/// Effective mass (kg) of two bodies at a point along a unit direction at their present poses: 1 / (sum of
/// mobilities). `other` may be null or fixed (infinite mass); the result is 0 when neither can move.
double effective_mass(const body::Body& struck, const body::Body* other, const Vec3& point_world,
                      const Vec3& direction_world);

}  // namespace shatterbox::world
