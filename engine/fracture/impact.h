// What presses on a body that may break, and what came of it: the words of every verdict, and the law of the
// force, which knows nothing of how the body is meshed.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/elementary.h"
#include "engine/core/vec.h"
#include "engine/fracture/dent.h"
#include "engine/fracture/striker.h"
#include "engine/geometry/mass_properties.h"
#include "engine/stress/contact_duration.h"

namespace shatterbox::fracture {

/// A push on the body at one place. Collisions make their force from the closing speed and the compliances;
/// contact (closing_speed = 0) and impacts of a given duration from `impulse`.
struct ImpactLoad {
  Vec3 point_material = Vec3::Zero();  // m
  Vec3 direction = Vec3::UnitX();      // unit; of the force on this body, material space
  double impulse = 0.0;         // N s, sum of the event: (1 + restitution) x effective mass x closing speed
  double closing_speed = 0.0;   // m/s; 0: not a collision, the impulse is averaged over `contact_average`
  double effective_mass = 0.0;  // kg, of both bodies along the direction
  double other_inverse_mass = 0.0;  // 1/kg, of the other body there; 0 for a floor
  double hertz_compliance = 0.0;    // m/N, of the contact itself
  double hertz_radius = 0.0;        // m, of the contact at its peak
  double restitution = 0.0;         // Newton's, of the pair: what it gives back nothing plastic has taken
  bool is_resting = false;          // contact that goes on: it dents nothing
  stress::Snapshots snapshots;      // of a collision's force; none: its peak counts
  std::shared_ptr<const Striker> striker;  // null: nobody who could go through
  bool was_asked = false;                  // whether he goes through, earlier in the event: he does not
};

struct Impact {
  std::vector<ImpactLoad> loads;         // all loads of the event and of resting contact
  Vec3 spin_material = Vec3::Zero();     // rad/s
  std::optional<double> given_duration;  // s; replaces the computed one
  double contact_average = 1.0 / 60.0;   // s
  bool has_torn = false;                 // of what yields: in this event, which does so once
  /// Stress over strength, anywhere, by what rests on the body alone, as an earlier solve told.
  std::optional<double> resting_ratio;
};

enum class Outcome : std::uint8_t { held, broke, not_evaluated };

/// An estimate of the ratio falls short of it by so many times at most, but for one of a thousand.
inline constexpr double kMostOverEstimate = 5.0;

struct Verdict {
  Outcome outcome = Outcome::not_evaluated;
  std::string reason;         // why not evaluated, or how it was settled ("bound")
  double duration = 0.0;      // s, of the impact
  double impulse = 0.0;       // N s, greatest of the loads
  double force = 0.0;         // N, peak, of the same load
  double stress = 0.0;        // Pa, greatest ratio's principal stress, at the pulse's peak
  double strength = 0.0;      // Pa, there
  double ratio = 0.0;         // stress / strength; below 1 the body holds
  bool is_estimate = false;   // duration, force, stress and ratio are, of one that plainly holds
  Vec3 place = Vec3::Zero();  // m, material space
  double von_mises = 0.0;     // Pa, greatest, under the collisions alone; 0: not asked for
  double yield = 0.0;         // Pa; 0: the material does not yield, or it was not asked

  /// What the ratio may be.
  double most_ratio() const { return is_estimate ? kMostOverEstimate * ratio : ratio; }
};

inline bool is_collision(const ImpactLoad& load) {
  return load.closing_speed > 0.0 && load.effective_mass > 0.0;
}

inline bool was_asked(const Impact& impact) {
  return std::any_of(impact.loads.begin(), impact.loads.end(),
                     [](const ImpactLoad& load) { return load.was_asked; });
}

/// Peak force of a collision, N: all kinetic energy in a spring of `compliance` (m/N), contact and body in
/// series.
inline double collision_force(const ImpactLoad& load, double compliance) {
  return load.closing_speed * core::sqrt(load.effective_mass / compliance);
}

/// True if snapshots of springs, whose energy nothing bounds, stand for the collisions' peaks.
inline bool are_snapshots(const Impact& impact) {
  return std::any_of(impact.loads.begin(), impact.loads.end(),
                     [](const ImpactLoad& load) { return load.snapshots.step > 0.0; });
}

/// J; 0 of what is no collision.
inline double collision_energy(const ImpactLoad& load) {
  return 0.5 * load.effective_mass * load.closing_speed * load.closing_speed;
}

/// Adds what a load brings for a dent, J. Of one that is no collision (a blast): what it leaves in the
/// springs, under its `force` (N) with the body's `elastic_compliance` (m/N).
inline void add_energy(const ImpactLoad& load, double force, double elastic_compliance, DentEnergy& sum) {
  if (load.is_resting) return;
  const double energy =
      is_collision(load) ? collision_energy(load) : 0.5 * force * force * elastic_compliance;
  sum.all += energy;
  sum.most += (1.0 - load.restitution * load.restitution) * energy;
}

/// What the loads of an impact come to at most, as if they met in one place and pressed in one way. Of no
/// given duration.
class LoadBound {
 public:
  explicit LoadBound(const Impact& impact);

  /// Stress over strength where that is greatest, Pa.
  struct Worst {
    double stress = 0.0, strength = 0.0;
  };
  /// Of all places c, of which each bears `strength_of(c)` (Pa), and of which energy may gather in `rooms[c]`
  /// (m2 or m3): under `spin` (Pa), `per_newton` (Pa/N) of what bends the body, and `per_root_joule`
  /// (Pa/J^1/2, in a room of one); a hit does no more than its force or its energy. None if one may break.
  template <class StrengthOf>
  std::optional<Worst> harmless(const std::vector<double>& rooms, const StrengthOf& strength_of, double spin,
                                double per_newton, double per_root_joule) const {
    Worst worst;
    for (std::size_t c = 0; c < rooms.size(); ++c) {
      const double strength = strength_of(c);
      const double gathered = rooms[c] > 0.0 ? per_root_joule / core::sqrt(rooms[c]) : kBoundless;
      const double stress = spin + stress_at(strength, per_newton, gathered);
      if (!(stress < strength)) return std::nullopt;
      if (stress * worst.strength >= worst.stress * strength) worst = {stress, strength};
    }
    return worst;
  }

 private:
  static constexpr double kBoundless = 1e200;
  double stress_at(double strength, double per_newton, double per_root_joule) const;

  double root_energy_ = 0.0;    // J^1/2, of collisions
  double hit_force_ = 0.0;      // N, of collisions with a body that gives no way
  double contact_force_ = 0.0;  // N, of what else presses, and is not known to be borne
  double borne_ratio_ = 0.0;    // stress over strength, anywhere, of what is
};

/// Share of a load's energy (J) that cracks which took `spent` J have left.
inline double share_left(double energy, double spent) {
  return std::max(0.0, 1.0 - spent / std::max(energy, 1e-300));
}

/// Force on the cracked body, N: as much less than at first as it gives way more, and as there is energy left
/// (`left`: a share). Compliances in m/N: of the contact, of the body at first and now, and of the other
/// body's inertia.
inline double cracked_force(double first_force, double contact, double first, double now, double other,
                            double left) {
  const double force = first_force * (contact + first + other) / (contact + now + other) * core::sqrt(left);
  return std::min(force, first_force);
}

/// The force that springs of that elastic compliance (m/N) hold with `energy` J in them, N.
inline double force_of_energy(double energy, double compliance) {
  return core::sqrt(2.0 * energy / compliance);
}

/// m, the moment about the centre of mass of a unit force along a load.
Vec3 arm_of(const geometry::MassProperties& mass, const ImpactLoad& load);
/// J, twice what a free body has from that impulse (N s) and its moment about the centre of mass (N m s).
double rigid_mobility(const geometry::MassProperties& mass, const Vec3& impulse, const Vec3& moment);
/// Inverse mass of a free body at a load along its direction, 1/kg.
double rigid_mobility(const geometry::MassProperties& mass, const ImpactLoad& load);

}  // namespace shatterbox::fracture
