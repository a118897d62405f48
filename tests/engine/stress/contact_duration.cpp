// Hertz's impact against its integral, both limits of the series, and the fixed point (NUMERICS case 17).
#include "engine/stress/contact_duration.h"

#include <catch2/catch.hpp>
#include <vector>

#include "engine/core/elementary.h"
#include "engine/stress/shell_system_cache.h"

using namespace shatterbox;
using namespace shatterbox::stress;

namespace {

HertzContact glass_balls() {
  const ContactSurface ball{70e9, 0.22, 0.02};
  return make_hertz_contact(ball, ball, 1e-4, 1.0);
}

/// Duration and peak force of m x'' = -k x^(3/2) - nothing else, by small steps.
std::pair<double, double> simulate(const HertzContact& contact, double mass, double speed) {
  const double stiffness = hertz_stiffness(contact);
  const double step = hertz_duration(contact, mass, speed) / 200000.0;
  double depth = 0.0, velocity = speed, time = 0.0, peak = 0.0;
  while (depth >= 0.0) {
    const double half = depth + 0.5 * step * velocity;
    const double force = stiffness * half * core::sqrt(std::max(half, 0.0));
    peak = std::max(peak, force);
    velocity -= step * force / mass;
    depth = half + 0.5 * step * velocity;
    time += step;
  }
  return {time, peak};
}

}  // namespace

TEST_CASE("Hertz contact of two balls: modulus, radius, duration, peak force") {
  const HertzContact contact = glass_balls();
  REQUIRE(contact.radius == Approx(0.01).epsilon(1e-14));
  REQUIRE(contact.modulus == Approx(70e9 / (2.0 * (1.0 - 0.22 * 0.22))).epsilon(1e-14));
  const double mass = 0.04, speed = 3.0;
  const double formula =
      2.8682656991953315 *
      core::pow(mass * mass / (contact.radius * contact.modulus * contact.modulus * speed), 0.2);
  REQUIRE(hertz_duration(contact, mass, speed) == Approx(formula).epsilon(1e-12));
  const auto [time, peak] = simulate(contact, mass, speed);
  REQUIRE(time == Approx(formula).epsilon(1e-4));
  REQUIRE(peak_force(contact, mass, speed) == Approx(peak).epsilon(1e-6));
  // peak over mean: mean = 2 m v / T
  REQUIRE(peak_force(contact, mass, speed) * formula / (2.0 * mass * speed) ==
          Approx(kPeakOverMeanHertz).epsilon(1e-12));
  // depth from the two formulas agrees with a^2 = R depth
  const double force = peak_force(contact, mass, speed);
  const double a = hertz_patch_radius(contact, force);
  REQUIRE(a * a / contact.radius == Approx(force * hertz_compliance(contact, force)).epsilon(1e-12));
}

TEST_CASE("planes and rigid things") {
  const ContactSurface ball{70e9, 0.22, 0.02}, floor{0.0, 0.0, 0.0};
  const HertzContact contact = make_hertz_contact(ball, floor, 1e-3, 1.0);
  REQUIRE(contact.radius == Approx(0.02));
  REQUIRE(contact.modulus == Approx(70e9 / (1.0 - 0.22 * 0.22)));
  const HertzContact flat = make_hertz_contact(floor, floor, 1e-3, 0.5);
  REQUIRE(flat.radius == 0.5);
  REQUIRE(flat.modulus == 1e13);
  const ContactSurface corner{70e9, 0.22, 1e-9};
  REQUIRE(make_hertz_contact(corner, floor, 1e-3, 1.0).radius == Approx(1e-3));
}

TEST_CASE("in series with a spring: energy is kept, a soft body sets the duration") {
  const HertzContact contact = glass_balls();
  const double mass = 0.04, speed = 3.0;
  for (const double compliance : {0.0, 1e-9, 1e-7, 1e-5, 1e-2, 1e6}) {
    const double force = peak_force(contact, mass, speed, compliance);
    const double depth = force * hertz_compliance(contact, force);
    REQUIRE(0.4 * force * depth + 0.5 * compliance * force * force ==
            Approx(0.5 * mass * speed * speed).epsilon(1e-10));
    const double duration = series_duration(mass, hertz_compliance(contact, force), compliance);
    if (compliance == 0.0) REQUIRE(duration == Approx(hertz_duration(contact, mass, speed)).epsilon(0.05));
    if (compliance >= 1e-2)
      REQUIRE(duration == Approx(core::kPi * core::sqrt(mass * compliance)).epsilon(0.01));
  }
  REQUIRE(peak_force(contact, mass, 0.0) == 0.0);
}

TEST_CASE("snapshots of a penalty's force: the peak for short steps, one deep overlap for long ones") {
  const double duration = 1e-3, omega = core::kPi / duration;
  REQUIRE(seen_over_peak({}, duration) == 1.0);
  REQUIRE(seen_over_peak({1e-8 * duration, 0.0}, duration) == 1.0);
  // Symplectic Euler is of the first order.
  for (const double share : {0.04, 0.02, 0.01})
    REQUIRE(std::abs(seen_over_peak({share * duration, 0.5 * share * duration}, duration) - 1.0) <
            0.2 * share);
  // A step so long that the spring throws the body out at once: the force is that of the way to the border.
  for (const double first : {1.0, 7.0, 30.0})
    REQUIRE(seen_over_peak({30.0 * duration, first * duration}, duration) ==
            Approx(omega * first * duration).epsilon(1e-14));
}
