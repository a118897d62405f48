// Solves with closed-form answers of plates, discs and spheres (NUMERICS cases 9, 13 to 16).
#include <catch2/catch.hpp>
#include <cmath>

#include "sandbox/study/shell_models.h"
#include "sandbox/study/stress_cases.h"

using namespace shatterbox::sandbox::study;

TEST_CASE("square plates, simply supported and clamped: deflection and moment converge") {
  const StressCase simple16 = square_plate(16, false), simple32 = square_plate(32, false);
  const StressCase clamped16 = square_plate(16, true), clamped32 = square_plate(32, true);
  CAPTURE(simple16.deflection, simple32.deflection, clamped16.deflection, clamped32.deflection);
  CAPTURE(simple16.rim, simple32.rim, clamped16.rim, clamped32.rim);
  CAPTURE(simple16.raw, simple32.raw, clamped16.raw, clamped32.raw);
  REQUIRE(std::abs(simple16.deflection - 1.0) < 0.06);
  REQUIRE(std::abs(simple32.deflection - 1.0) < 0.02);
  REQUIRE(std::abs(clamped16.deflection - 1.0) < 0.13);
  REQUIRE(std::abs(clamped32.deflection - 1.0) < 0.04);
  REQUIRE(std::abs(simple32.rim) < 0.02);
  REQUIRE(std::abs(clamped32.rim) < 0.04);
  REQUIRE(simple16.raw < 0.02);
  REQUIRE(clamped16.raw < 0.02);
  REQUIRE(simple32.raw < 0.006);
  for (const StressCase& plate : {simple16, simple32, clamped16, clamped32}) REQUIRE(plate.residual < 1e-8);
}

TEST_CASE("free disc hit in the middle: closed form of the relieved load") {
  const auto elements = model::disc(4);
  const auto stiffness = shatterbox::stress::make_shell_stiffness(elements, model::properties_of(0.01));
  REQUIRE(
      model::make_system(stiffness, shatterbox::geometry::make_shell_mesh(elements))->rigid_mode_count() ==
      6);
  const StressCase coarse = free_disc(8), middle = free_disc(16), fine = free_disc(32);
  CAPTURE(coarse.deflection, middle.deflection, fine.deflection);
  CAPTURE(coarse.raw, middle.raw, fine.raw);
  CAPTURE(coarse.averaged, middle.averaged, fine.averaged);
  REQUIRE(fine.residual < 1e-8);
  REQUIRE(std::abs(middle.deflection - 1.0) < 0.02);
  REQUIRE(std::abs(fine.deflection - 1.0) < 0.006);
  // Plain moments are one constant a triangle: first order away from the force (14.4, 7.3, 3.6 % at 8, 16, 32
  // rings outside a quarter of the radius, as NUMERICS has it for Morley's element), slowed by its logarithm
  // in the norm over the whole disc (19, 10.9, 6.0 %). The averaged ones, which the criterion reads, are held
  // to the tolerance everywhere.
  REQUIRE(middle.rim < 0.0735);
  REQUIRE(fine.rim < 0.0370);
  REQUIRE(fine.rim < 0.51 * middle.rim);
  REQUIRE(middle.raw < 0.6 * coarse.raw);
  REQUIRE(fine.raw < 0.6 * middle.raw);
  REQUIRE(middle.averaged < 0.07);
  REQUIRE(fine.averaged < 0.035);
}

TEST_CASE("pressurised sphere: p R / 2 t") {
  const StressCase sphere = pressed_sphere(4);
  CAPTURE(sphere.raw, sphere.rim);
  REQUIRE(sphere.residual < 1e-8);
  REQUIRE(sphere.raw < 0.005);
  REQUIRE(sphere.rim < 0.015);
}

TEST_CASE("sphere under two opposite forces: Reissner's deflection is approached, membranes alone diverge") {
  std::vector<double> ratios, membrane_ratios;
  for (int level = 3; level <= 5; ++level) {
    ratios.push_back(pinched_sphere(level, true).deflection);
    if (level < 5) membrane_ratios.push_back(pinched_sphere(level, false).deflection);
  }
  CAPTURE(ratios, membrane_ratios);
  REQUIRE(ratios[0] > ratios[1]);
  REQUIRE(ratios[1] > ratios[2]);
  REQUIRE(ratios[2] > 1.0);
  REQUIRE(ratios[2] < 1.2);
  REQUIRE(membrane_ratios[1] > 3.0 * membrane_ratios[0]);
}
