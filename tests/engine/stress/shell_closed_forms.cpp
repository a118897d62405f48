// Solves with closed-form answers of plates, discs and spheres (NUMERICS cases 9, 13 to 16).
#include <catch2/catch.hpp>
#include <cmath>

#include "engine/stress/shell_stress.h"
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

TEST_CASE("pressurised sphere, thin to 1e-6 of its size, thick as itself, and of rubber") {
  using namespace shatterbox;
  const auto elements = model::icosphere(3);
  const geometry::ShellMesh mesh = geometry::make_shell_mesh(elements);
  for (const double thickness : {1e-6, 1e-4, 1e-2, 1.0})
    for (const double poisson : {0.0, 0.3, 0.4999}) {
      const stress::ShellProperties properties = model::properties_of(thickness, poisson);
      const auto stiffness = stress::make_shell_stiffness(elements, properties);
      const auto solution = model::make_system(stiffness, mesh)->solve(model::pressure_load(mesh, 1.0));
      REQUIRE(solution.is_evaluated());
      const auto stresses = stress::cell_stresses(*stiffness, mesh, solution.displacement);
      double sum = 0.0, area = 0.0;
      for (std::size_t c = 0; c < stresses.size(); ++c) {
        sum += mesh.cells[c].area * 0.5 * (stresses[c].membrane(0) + stresses[c].membrane(1));
        area += mesh.cells[c].area;
      }
      CAPTURE(thickness, poisson);
      CHECK(sum / area == Approx(0.5 / thickness).epsilon(0.01));
    }
}

TEST_CASE("a row of slivers to 1e-6 of their length does not change a plate's answer") {
  using namespace shatterbox;
  const auto deflection = [](double width) {
    geometry::TriangleMesh mesh = model::grid_mesh(17, 16, 1.0, 1.0);
    // The middle column of cells becomes that narrow, the others take its place.
    for (Vec3& p : mesh.positions) {
      const double column = p.x() * 17.0;
      p.x() = column < 8.5 ? column / 8.0 * 0.5 * (1.0 - width)
                           : 1.0 - (17.0 - column) / 8.0 * 0.5 * (1.0 - width);
    }
    const auto elements = model::make_elements(mesh);
    const geometry::ShellMesh cells = geometry::make_shell_mesh(elements);
    const stress::ShellProperties properties = model::properties_of(0.01);
    const auto stiffness = stress::make_shell_stiffness(elements, properties);
    const auto solution = model::make_system(stiffness, cells, 0.0, model::square_support(cells, false))
                              ->solve(model::pressure_load(cells, 1.0));
    REQUIRE(solution.is_evaluated());
    double most = 0.0;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
      most = std::max(most, solution.displacement(stress::vertex_dof(static_cast<int>(v)) + 2));
    return most * model::bending_stiffness(properties) / 0.00406235;
  };
  for (const double width : {1e-2, 1e-4, 1e-6}) {
    CAPTURE(width);
    CHECK(deflection(width) == Approx(1.0).epsilon(0.03));
  }
}
