// How long an impact lasts and how hard it presses: Hertz's contact (K. L. Johnson, Contact Mechanics, 1985,
// ch. 4, 11) in series with the body's own compliance. Hertz alone makes the stress of thin things many times
// too high.
#pragma once

namespace shatterbox::stress {

/// Greatest force over mean force of a half-sine pulse, pi / 2.
inline constexpr double kPeakOverMeanHalfSine = 1.5707963267948966;
/// The same of Hertz's elastic pulse, (5/8) 2.9432...
inline constexpr double kPeakOverMeanHertz = 1.8395469902029404;

/// Elasticity and curvature of one of the two surfaces that meet.
struct ContactSurface {
  double youngs_modulus = 70e9;  // Pa; 0 means rigid
  double poisson_ratio = 0.22;
  double radius = 0.0;  // m, of curvature; 0 means a plane
  bool operator==(const ContactSurface&) const = default;
};

struct HertzContact {
  double modulus = 0.0;  // Pa, E*: 1/E* = sum (1 - nu^2)/E
  double radius = 0.0;   // m, R*: 1/R* = sum 1/R
};

/// Two spheres, or a sphere and a plane. Two planes get `largest_radius` (m, the size of the smaller body): a
/// flat contact is a blunt one. Two rigid surfaces get the modulus 1e13 Pa. Radii are clamped to
/// [least_radius, largest_radius].
HertzContact make_hertz_contact(const ContactSurface& a, const ContactSurface& b, double least_radius,
                                double largest_radius);

/// F = stiffness * depth^(3/2): (4/3) E* sqrt(R*), N m^-1.5.
double hertz_stiffness(const HertzContact& contact);

/// Duration of an elastic impact by Hertz alone, s: 2.868... (m^2 / (R E*^2 v))^(1/5). mass: effective, kg;
/// speed > 0, m/s.
double hertz_duration(const HertzContact& contact, double mass, double speed);

/// Peak force (N) of an impact of `mass` (effective, kg) at `speed` (m/s): all kinetic energy goes into
/// Hertz's contact and a linear spring of `body_compliance` (m/N) in series.
double peak_force(const HertzContact& contact, double mass, double speed, double body_compliance = 0.0);

/// Depth over force at the given peak force, m/N: Hertz's spring made linear there.
double hertz_compliance(const HertzContact& contact, double force);

/// Radius of the circle of contact at a force, m: (3 F R / 4 E*)^(1/3).
double hertz_patch_radius(const HertzContact& contact, double force);

/// m, at the end of a hit of `energy` J that presses a round body into one that flows under `hardness` (Pa)
/// over all of the patch: (4 R* energy / (pi hardness))^(1/4), at most R*. [Hertz] ch. 11
double plastic_patch_radius(const HertzContact& contact, double energy, double hardness);

/// pi sqrt(mass (contact_compliance + body_compliance)), s.
double series_duration(double mass, double contact_compliance, double body_compliance);

/// When the force of a penalty method is looked at: at the borders of steps.
struct Snapshots {
  double step = 0.0;   // s; 0: never, the pulse is known whole
  double first = 0.0;  // s, from the touch to the first border
};

/// The greatest force that a penalty method sees over the true peak, for the comparison of [BHTF07] figs. 9
/// and 10: bodies fly on to the border before they know that they overlap, then a spring of the impact's own
/// compliance, so of `duration` (s), drives them apart in steps (symplectic Euler). Tends to 1 for short
/// steps, grows without end with long ones. 1 without snapshots.
double seen_over_peak(const Snapshots& snapshots, double duration);

}  // namespace shatterbox::stress
