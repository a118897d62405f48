// Solves: balance, supports, screening, cuts, periods, threads.
#include "engine/stress/shell_system.h"

#include <catch2/catch.hpp>

#include "engine/core/index.h"
#include "engine/core/parallel.h"
#include "engine/stress/shell_load.h"
#include "engine/stress/shell_stress.h"
#include "engine/stress/shell_system_cache.h"
#include "tests/engine/stress/meshes.h"
#include "tests/engine/stress/solving.h"

using namespace shatterbox;
using namespace shatterbox::stress;
using namespace shatterbox::stress::testing;

using core::at;
using std::size_t;

TEST_CASE("a balanced load gives one stress, wherever the body is pinned") {
  const Elements elements = icosphere(2);
  const auto stiffness = make_shell_stiffness(elements, properties_of(0.03));
  const geometry::ShellMesh mesh = geometry::make_shell_mesh(elements);
  VecX load = VecX::Zero(mesh.degree_of_freedom_count());
  load.segment<3>(vertex_dof(40)) = Vec3(0.3, -0.2, 1.0);
  const ShellSolution free = make_system(stiffness, mesh)->solve(load);
  const auto stress_free = cell_stresses(*stiffness, mesh, free.displacement);
  const VecX balanced = apply_stiffness(*stiffness, mesh, free.displacement);
  Vec3 resultant = Vec3::Zero(), moment = Vec3::Zero();
  for (int v = 0; v < static_cast<int>(mesh.vertex_source.size()); ++v) {
    resultant += balanced.segment<3>(vertex_dof(v));
    moment += elements->mesh.positions[at(v)].cross(Vec3(balanced.segment<3>(vertex_dof(v))));
  }
  REQUIRE(resultant.norm() < 1e-9 * load.norm());
  // The edges' inertia takes a share of the moment.
  REQUIRE(moment.norm() < 1e-3 * load.norm());

  // One vertex and the rotations about three edges hold exactly the six rigid motions.
  const std::vector<std::array<int, 4>> pins{{0, 3, 100, 251}, {77, 20, 333, 401}, {40, 450, 7, 180}};
  for (const auto& pin : pins) {
    ShellSupport support;
    support.vertices = {pin[0]};
    support.edges = {pin[1], pin[2], pin[3]};
    const auto system = make_system(stiffness, mesh, 0.0, support);
    REQUIRE(system->rigid_mode_count() == 0);
    const ShellSolution held = system->solve(balanced);
    REQUIRE(held.residual < 1e-9);
    REQUIRE(stress_norms(cell_stresses(*stiffness, mesh, held.displacement), stress_free).x() < 1e-8);
    // The load that is not in balance pulls at the pins: another stress altogether.
    const ShellSolution wrong = system->solve(load);
    REQUIRE(stress_norms(cell_stresses(*stiffness, mesh, wrong.displacement), stress_free).x() > 0.1);
  }
}

TEST_CASE("the inertia of a free strip pulled or pushed at one end: tension N(x) = F x / L") {
  const Elements elements = grid(40, 4, 2.0, 0.2);
  const auto stiffness = make_shell_stiffness(elements, properties_of(0.01, 0.0));
  const geometry::ShellMesh mesh = geometry::make_shell_mesh(elements);
  const auto system = make_system(stiffness, mesh);
  for (const double sign : {1.0, -1.0}) {
    VecX load = VecX::Zero(mesh.degree_of_freedom_count());
    for (int j = 0; j <= 4; ++j)
      load(vertex_dof(41 * j + 40)) = sign * 100.0 * (j == 0 || j == 4 ? 0.125 : 0.25);
    const auto stresses = cell_stresses(*stiffness, mesh, system->solve(load).displacement);
    for (size_t c = 0; c < stresses.size(); ++c) {
      const double x =
          geometry::position_in_element(*elements, static_cast<int>(c), Vec2(1.0 / 3.0, 1.0 / 3.0)).x();
      if (x < 0.3 || x > 1.7) continue;
      const double expected = sign * 100.0 * x / 2.0 / (0.2 * 0.01);
      const PrincipalStress principal = principal_stress(stresses[c].membrane);
      const double axial = sign > 0.0 ? principal.first : principal.second;
      REQUIRE(axial == Approx(expected).epsilon(0.04));
      if (sign < 0.0) REQUIRE(principal.first < 0.05 * std::abs(expected));
    }
  }
}

TEST_CASE("first period: free square plate and clamped square plate") {
  const Elements elements = grid(24, 24, 1.0, 1.0, 0.2);
  const ShellProperties properties = properties_of(0.01, 0.3);
  const auto stiffness = make_shell_stiffness(elements, properties);
  const geometry::ShellMesh mesh = geometry::make_shell_mesh(elements);
  const double unit = core::sqrt(properties.density * properties.thickness / bending_stiffness(properties));
  // Leissa: lambda = omega a^2 sqrt(rho t / D) is 13.468 free (nu = .3), 35.985 clamped.
  REQUIRE(make_system(stiffness, mesh)->first_period() ==
          Approx(2.0 * core::kPi * unit / 13.468).epsilon(0.03));
  const auto clamped = make_system(stiffness, mesh, 0.0, square_support(mesh, true));
  REQUIRE(clamped->first_period() == Approx(2.0 * core::kPi * unit / 35.985).epsilon(0.06));
}

TEST_CASE("a trial motion's period is never above the first one, and that of the first motion itself") {
  const ShellProperties properties = properties_of(0.01);
  for (const Elements& elements : {grid(14, 11, 1.0, 0.7, 0.3), disc(6), icosphere(2)}) {
    const auto stiffness = make_shell_stiffness(elements, properties);
    const geometry::ShellMesh mesh = geometry::make_shell_mesh(elements);
    const auto balanced = make_system(stiffness, mesh);
    const double period = balanced->first_period();
    VecX load = VecX::Zero(mesh.degree_of_freedom_count());
    load.segment<3>(3) = Vec3(0.3, -0.2, 1.0);
    for (const double screening : {0.0, 0.3 / period, 3.0 / period, 60.0 / period}) {
      const auto system = make_system(stiffness, mesh, screening);
      CHECK(system->trial_period(system->solve(load)) < 1.001 * period);
    }
    // Solving again and again under its own inertia turns any motion into the first one.
    ShellSolution solution = balanced->solve(load);
    const VecX mass = lumped_mass(*stiffness, mesh);
    for (int i = 0; i < 25; ++i)
      solution =
          balanced->solve(VecX(mass.cwiseProduct(solution.displacement) / solution.displacement.norm()));
    CHECK(balanced->trial_period(solution) == Approx(period).epsilon(0.03));
  }
}

TEST_CASE("whether the first period is above a limit is what the period says") {
  const ShellProperties properties = properties_of(0.01);
  const Elements plate = grid(14, 11, 1.0, 0.7, 0.3);
  const std::vector<Elements> shapes{plate, grid(30, 3, 2.0, 0.1, 0.2), disc(6), icosphere(2)};
  const auto check = [&](const std::shared_ptr<const ShellStiffness>& stiffness,
                         const geometry::ShellMesh& mesh) {
    const double period = make_system(stiffness, mesh)->first_period();
    for (const double share : {0.1, 0.5, 0.8, 0.97, 1.03, 1.2, 1.6, 3.0, 30.0}) {
      CAPTURE(share, period);
      REQUIRE(make_system(stiffness, mesh)->is_first_period_above(share * period) == (share < 1.0));
    }
  };
  for (const Elements& elements : shapes)
    check(make_shell_stiffness(elements, properties), geometry::make_shell_mesh(elements));
  check(make_shell_stiffness(plate, properties), cut_between(geometry::make_shell_mesh(plate), 0.4713));
}

TEST_CASE("the screened solve tends to the balanced one as the window grows, and is local when it is short") {
  const Elements elements = grid(20, 20, 1.0, 1.0, 0.2);
  const auto stiffness = make_shell_stiffness(elements, properties_of(0.01));
  const geometry::ShellMesh mesh = geometry::make_shell_mesh(elements);
  const VecX load = patch_load(mesh, find_load_patch(mesh, Vec3(0.3, 0.35, 0.0), 0.1), Vec3(0.0, 0.0, 1.0));
  const auto balanced = make_system(stiffness, mesh);
  const auto expected = cell_stresses(*stiffness, mesh, balanced->solve(load).displacement);
  const double omega = 2.0 * core::kPi / balanced->first_period();
  double previous = 1e9;
  for (const double s : {1.0, 0.1, 0.01, 1e-3}) {
    const ShellSolution solution = make_system(stiffness, mesh, s * omega)->solve(load);
    REQUIRE(solution.residual < 1e-6);
    REQUIRE(solution.compliance > solution.elastic_compliance);
    const double error = stress_norms(cell_stresses(*stiffness, mesh, solution.displacement), expected).x();
    REQUIRE(error < previous);
    previous = error;
  }
  CAPTURE(previous);
  REQUIRE(previous < 1e-4);
  const ShellSolution brief = make_system(stiffness, mesh, 100.0 * omega)->solve(load);
  const auto near = cell_stresses(*stiffness, mesh, brief.displacement);
  double inside = 0.0, outside = 0.0;
  for (size_t c = 0; c < near.size(); ++c) {
    const Vec3 x = geometry::position_in_element(*elements, static_cast<int>(c), Vec2(1.0 / 3.0, 1.0 / 3.0));
    double& greatest = (x - Vec3(0.3, 0.35, 0.0)).norm() < 0.2 ? inside : outside;
    greatest = std::max(greatest, near[c].bending.norm());
  }
  REQUIRE(outside < 0.15 * inside);
}

TEST_CASE("a plate cut in two is two bodies, half a cut leaves one") {
  const Elements elements = grid(9, 6, 1.0, 0.7, 0.3);
  const auto stiffness = make_shell_stiffness(elements, properties_of(0.01));
  const geometry::ShellMesh whole = geometry::make_shell_mesh(elements);
  const geometry::ShellMesh cut = cut_between(whole, 0.4713);
  REQUIRE(cut.cells.size() > whole.cells.size());
  const auto system = make_system(stiffness, cut);
  REQUIRE(system->part_count() == 2);
  REQUIRE(system->rigid_mode_count() == 12);
  // A load on one half moves nothing in the other.
  VecX load = VecX::Zero(cut.degree_of_freedom_count());
  double left = 0.0;
  int loaded = -1;
  for (size_t c = 0; c < cut.cells.size(); ++c)
    if (geometry::position_in_element(*elements, cut.cells[c].element, Vec2(0.3, 0.3)).x() < 0.2) {
      load(vertex_dof(cut.cells[c].vertices[0]) + 2) = 1.0;
      loaded = static_cast<int>(c);
      break;
    }
  REQUIRE(loaded >= 0);
  const ShellSolution solution = system->solve(load);
  REQUIRE(solution.residual < 1e-7);
  const auto stresses = cell_stresses(*stiffness, cut, solution.displacement);
  double right = 0.0;
  for (size_t c = 0; c < cut.cells.size(); ++c) {
    double x = 0.0;
    for (int i = 0; i < cut.cells[c].corner_count; ++i)
      x += geometry::position_in_element(*elements, cut.cells[c].element,
                                         cut.corners[at(cut.cells[c].first_corner + i)].barycentric)
               .x() /
           cut.cells[c].corner_count;
    double& greatest = x < 0.4713 ? left : right;
    greatest = std::max(greatest, stresses[c].bending.norm());
  }
  REQUIRE(left > 0.0);
  REQUIRE(right < 1e-12 * left);
}

TEST_CASE("a support holds only what touches it: the loose half of a cut plate stays free") {
  const Elements elements = grid(10, 6, 1.0, 0.6);
  const auto stiffness = make_shell_stiffness(elements, properties_of(0.01));
  const geometry::ShellMesh whole = geometry::make_shell_mesh(elements);
  std::vector<char> vertices(elements->mesh.positions.size(), 0), edges(elements->topology.edges.size(), 1);
  for (int j = 0; j <= 6; ++j) vertices[at(11 * j)] = 1;
  const auto held = make_system(stiffness, whole, 0.0, find_support(whole, vertices, edges));
  REQUIRE(held->rigid_mode_count() == 0);
  const geometry::ShellMesh cut = cut_between(whole, 0.55);
  const auto half = make_system(stiffness, cut, 0.0, find_support(cut, vertices, edges));
  REQUIRE(half->part_count() == 2);
  REQUIRE(half->rigid_mode_count() == 6);

  // Cantilever: F L^3 / 3 E I for nu = 0.
  const auto beam = make_shell_stiffness(elements, properties_of(0.01, 0.0));
  const auto cantilever = make_system(beam, whole, 0.0, find_support(whole, vertices, edges));
  VecX load = VecX::Zero(whole.degree_of_freedom_count());
  for (int j = 0; j <= 6; ++j) load(vertex_dof(11 * j + 10) + 2) = (j == 0 || j == 6 ? 0.5 : 1.0) / 6.0;
  const ShellSolution solution = cantilever->solve(load);
  const double inertia = 0.6 * 1e-6 / 12.0;
  REQUIRE(solution.compliance == Approx(1.0 / (3.0 * 2e9 * inertia)).epsilon(0.02));
  REQUIRE(solution.elastic_compliance == Approx(solution.compliance).epsilon(1e-8));
}

TEST_CASE("a vertex hinge alone: the answer says that it is none") {
  ShellProperties properties = properties_of(0.01);
  properties.has_bending = false;
  const Elements elements = grid(6, 6, 1.0, 1.0);
  const auto stiffness = make_shell_stiffness(elements, properties);
  const geometry::ShellMesh mesh = geometry::make_shell_mesh(elements);
  VecX load = VecX::Zero(mesh.degree_of_freedom_count());
  load(vertex_dof(24) + 2) = 1.0;
  REQUIRE_FALSE(make_system(stiffness, mesh)->solve(load).is_evaluated());
}

TEST_CASE("scale: the stress does not depend on E, and follows force / length^2") {
  const auto worst_of = [](double size, double modulus, double thickness) {
    const Elements elements = grid(10, 8, size, 0.8 * size, 0.3);
    ShellProperties properties = properties_of(thickness);
    properties.youngs_modulus = modulus;
    const auto stiffness = make_shell_stiffness(elements, properties);
    const geometry::ShellMesh mesh = geometry::make_shell_mesh(elements);
    VecX load = VecX::Zero(mesh.degree_of_freedom_count());
    load.segment<3>(vertex_dof(37)) = Vec3(0.1, 0.2, 1.0);
    const auto solution = make_system(stiffness, mesh)->solve(load);
    REQUIRE(solution.residual < 1e-7);
    double worst = 0.0;
    for (const CellStress& stress : cell_stresses(*stiffness, mesh, solution.displacement))
      worst = std::max(worst, worst_stress(stress).principal.first);
    return worst;
  };
  const double reference = worst_of(1.0, 70e9, 0.01);
  REQUIRE(worst_of(1.0, 1e12, 0.01) == Approx(reference).epsilon(1e-7));
  REQUIRE(worst_of(1.0, 1e3, 0.01) == Approx(reference).epsilon(1e-7));
  REQUIRE(worst_of(1e-4, 70e9, 1e-6) == Approx(reference * 1e8).epsilon(1e-6));
  REQUIRE(worst_of(1e4, 70e9, 100.0) == Approx(reference * 1e-8).epsilon(1e-6));
}

TEST_CASE("same bits for one and two threads, alone or in company") {
  const Elements elements = icosphere(4);
  const auto stiffness = make_shell_stiffness(elements, properties_of(0.02));
  const geometry::ShellMesh mesh = geometry::make_shell_mesh(elements);
  std::vector<VecX> loads;
  for (int i = 0; i < 6; ++i) {
    loads.push_back(VecX::Zero(mesh.degree_of_freedom_count()));
    loads.back().segment<3>(vertex_dof(100 * i + 3)) = Vec3(0.1 * i, 1.0, -0.5);
  }
  std::vector<std::vector<ShellSolution>> all;
  for (const int threads : {1, 2}) {
    core::set_thread_count(threads);
    const auto system = make_system(stiffness, mesh, threads == 1 ? 0.0 : 0.0);
    all.push_back(system->solve(loads));
    REQUIRE(system->solve(loads[2]).displacement == all.back()[2].displacement);
  }
  core::set_thread_count(0);
  for (size_t i = 0; i < loads.size(); ++i) {
    REQUIRE(all[0][i].displacement == all[1][i].displacement);
    REQUIRE(all[0][i].compliance == all[1][i].compliance);
  }
}

TEST_CASE("the cache makes each system once and shares it, tells its memory and gives it up") {
  const Elements elements = grid(6, 6, 1.0, 1.0);
  const auto stiffness = make_shell_stiffness(elements, properties_of(0.01));
  const auto mesh = std::make_shared<const geometry::ShellMesh>(geometry::make_shell_mesh(elements));
  ShellSystemCache cache(stiffness, mesh);
  REQUIRE(cache.unscreened().ok());
  REQUIRE(cache.unscreened().value() == cache.unscreened().value());
  REQUIRE(cache.screened(8).value() == cache.screened(8).value());
  REQUIRE(cache.screened(8).value()->screening() == 256.0);
  REQUIRE(cache.count() == 2);
  // A factor is more than its entries: triangles of pivots are kept as squares, rows by four.
  const double entries = sizeof(double) * cache.unscreened().value()->factor_entries();
  REQUIRE(cache.bytes() > 2.0 * entries);
  REQUIRE(cache.bytes() < 6.0 * entries);
  cache.give_up();
  REQUIRE(cache.count() == 0);
  REQUIRE(cache.bytes() == 0.0);
  REQUIRE(cache.screened(8).value()->screening() == 256.0);
  REQUIRE(cache.count() == 1);
  REQUIRE(quantise_screening(256.0) == 8);
  REQUIRE(quantise_screening(300.0) == 8);
  REQUIRE(quantise_screening(400.0) == 9);
  REQUIRE(quantise_screening(0.3) == -2);
}

TEST_CASE("a solve stopped early is as near as it says, and its energy is that of its displacement") {
  const Elements elements = icosphere(3);
  const auto stiffness = make_shell_stiffness(elements, properties_of(0.01));
  const geometry::ShellMesh mesh = geometry::make_shell_mesh(elements);
  VecX load = VecX::Zero(mesh.degree_of_freedom_count());
  load.segment<3>(vertex_dof(7)) = Vec3(0.3, 1.0, -0.5);
  for (const double screening : {0.0, 1000.0}) {
    const auto system = make_system(stiffness, mesh, screening);
    const ShellSolution fine = system->solve(load);
    const ShellSolution rough = system->solve(load, 1e-5);
    REQUIRE(rough.residual <= 1e-5);
    REQUIRE(rough.compliance == Approx(fine.compliance).epsilon(1e-6));
    REQUIRE((rough.displacement - fine.displacement).norm() < 1e-4 * fine.displacement.norm());
    const VecX image = apply_stiffness(*stiffness, mesh, fine.displacement);
    REQUIRE(fine.elastic_compliance == Approx(fine.displacement.dot(image)).epsilon(1e-6));
  }
}
