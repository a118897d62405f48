#include "engine/stress/contact_duration.h"

#include <algorithm>

#include "engine/core/elementary.h"

namespace shatterbox::stress {
namespace {

/// 2.9432... (15/16)^(2/5), 2.9432... = (4 sqrt(pi) / 5) Gamma(2/5) / Gamma(9/10).
constexpr double kHertzDuration = 2.8682656991953315;
constexpr double kRigidModulus = 1e13;  // Pa

double inverse_modulus(const ContactSurface& surface) {
  if (!(surface.youngs_modulus > 0.0)) return 0.0;
  return (1.0 - surface.poisson_ratio * surface.poisson_ratio) / surface.youngs_modulus;
}

}  // namespace

HertzContact make_hertz_contact(const ContactSurface& a, const ContactSurface& b, double least_radius,
                                double largest_radius) {
  const double compliance = inverse_modulus(a) + inverse_modulus(b);
  double curvature = 0.0;
  for (const ContactSurface* surface : {&a, &b})
    if (surface->radius > 0.0) curvature += 1.0 / std::clamp(surface->radius, least_radius, largest_radius);
  return {compliance > 0.0 ? 1.0 / compliance : kRigidModulus,
          curvature > 0.0 ? 1.0 / curvature : largest_radius};
}

double hertz_stiffness(const HertzContact& contact) {
  return 4.0 / 3.0 * contact.modulus * core::sqrt(contact.radius);
}

double hertz_duration(const HertzContact& contact, double mass, double speed) {
  const double fifth_power = mass / contact.modulus * (mass / contact.modulus) / (contact.radius * speed);
  return kHertzDuration * core::pow(fifth_power, 0.2);
}

double peak_force(const HertzContact& contact, double mass, double speed, double body_compliance) {
  const double stiffness = hertz_stiffness(contact);
  const double twice_energy = mass * speed * speed;
  if (!(twice_energy > 0.0)) return 0.0;
  // Hertz alone: (2/5) stiffness depth^(5/2) is the energy.
  const double depth = core::pow(1.25 * twice_energy / stiffness, 0.4);
  const double hertz_force = stiffness * depth * core::sqrt(depth);
  // With F = hertz_force y^3 the energies are y^5 + spring y^6 = 1: convex, so Newton's steps come down
  // from 1.
  const double spring = body_compliance * hertz_force * hertz_force / twice_energy;
  double y = 1.0;
  for (int step = 0; step < 200; ++step) {
    const double y4 = y * y * y * y;
    const double correction = (y4 * y * (1.0 + spring * y) - 1.0) / (y4 * (5.0 + 6.0 * spring * y));
    y -= correction;
    if (correction <= 1e-15 * y) break;
  }
  return hertz_force * y * y * y;
}

double hertz_compliance(const HertzContact& contact, double force) {
  // depth / F with depth = (F / stiffness)^(2/3)
  const double stiffness = hertz_stiffness(contact);
  return 1.0 / core::pow(stiffness * stiffness * force, 1.0 / 3.0);
}

double hertz_patch_radius(const HertzContact& contact, double force) {
  return core::pow(0.75 * force * contact.radius / contact.modulus, 1.0 / 3.0);
}

double plastic_patch_radius(const HertzContact& contact, double energy, double hardness) {
  const double fourth = 4.0 * contact.radius * energy / (core::kPi * hardness);
  return std::min(core::sqrt(core::sqrt(fourth)), contact.radius);
}

double seen_over_peak(const Snapshots& snapshots, double duration) {
  constexpr double kShort = 1e-4;  // of the duration: a step that misses nothing
  if (!(snapshots.step > kShort * duration)) return 1.0;
  // In units of 1 / omega and of the closing speed: the overlap is the force over the peak.
  const double omega = core::kPi / duration, step = omega * snapshots.step;
  double speed = 1.0, greatest = 0.0;
  for (double overlap = omega * snapshots.first; overlap > 0.0; overlap += step * speed) {
    greatest = std::max(greatest, overlap);
    speed -= step * overlap;
  }
  return greatest;
}

double series_duration(double mass, double contact_compliance, double body_compliance) {
  return core::kPi * core::sqrt(mass * (contact_compliance + body_compliance));
}

}  // namespace shatterbox::stress
