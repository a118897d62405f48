// What of a sheet flows, layer by layer, and the shape that it leaves: strains that fit together come out as
// they are.
#include "engine/stress/shell_yield.h"

#include <catch2/catch.hpp>

#include "engine/stress/shell_system.h"
#include "tests/engine/stress/meshes.h"

using namespace shatterbox;
using namespace shatterbox::stress;
using namespace shatterbox::stress::testing;

using core::at;

namespace {

/// A strain of the plane's axes in those of an element.
Vec3 in_frame(const geometry::ShellElements& elements, int element, const Mat2& strain) {
  const Mat2 turn = geometry::facet_frame(elements, element).topLeftCorner<2, 2>();
  const Mat2 local = turn.transpose() * strain * turn;
  return {local(0, 0), local(1, 1), local(0, 1)};
}

}  // namespace

TEST_CASE("shell yield: a uniform plastic stretch and curvature is the shape of a free plate") {
  const Elements elements = grid(8, 6, 0.4, 0.3, 0.3);
  const geometry::ShellMesh mesh = geometry::make_shell_mesh(elements);
  const auto stiffness = make_shell_stiffness(elements, {210e9, 0.3, 7850.0, 1e-3});
  Mat2 stretch, curvature;
  stretch << 2e-3, 0.4e-3, 0.4e-3, -0.7e-3;
  curvature << 0.3, -0.1, -0.1, 0.2;  // 1/m
  std::vector<SheetStrain> strains;
  for (const geometry::ShellCell& cell : mesh.cells)
    strains.push_back(
        {in_frame(*elements, cell.element, stretch), in_frame(*elements, cell.element, curvature)});
  const auto system = make_system(stiffness, mesh);
  const ShellSolution shape = system->solve(eigenstrain_load(*stiffness, mesh, strains));
  REQUIRE(shape.is_evaluated());
  // What is left beside the strains moves as a rigid body: a linear function with a skew gradient.
  const auto count = static_cast<Eigen::Index>(mesh.vertex_source.size());
  Eigen::MatrixXd rigid(3 * count, 6);
  VecX rest(3 * count);
  for (Eigen::Index v = 0; v < count; ++v) {
    const Vec3 x = elements->mesh.positions[at(mesh.vertex_source[static_cast<std::size_t>(v)])];
    Vec3 wanted = Vec3::Zero();
    wanted.head<2>() = stretch * x.head<2>();
    wanted.z() = -0.5 * x.head<2>().dot(curvature * x.head<2>());  // convex outside stretches it
    rest.segment<3>(3 * v) = Vec3(shape.displacement.segment<3>(3 * v)) - wanted;
    rigid.block<3, 3>(3 * v, 0).setIdentity();
    for (int axis = 0; axis < 3; ++axis) rigid.block<3, 1>(3 * v, 3 + axis) = Vec3::Unit(axis).cross(x);
  }
  const VecX motion = rigid.colPivHouseholderQr().solve(rest);
  CHECK((rest - rigid * motion).cwiseAbs().maxCoeff() < 1e-9);
}

TEST_CASE("shell yield: a sheet bent beyond its yield strength flows at its faces, as the closed form says") {
  const Elements elements = grid(4, 4, 0.1, 0.1);
  const geometry::ShellMesh mesh = geometry::make_shell_mesh(elements);
  constexpr double kThickness = 2e-3, kYield = 235e6, kShear = 210e9 / 2.6;
  const auto stiffness = make_shell_stiffness(elements, {210e9, 0.3, 7850.0, kThickness});
  for (const double q : {0.999, 1.3, 2.0, 5.0}) {
    const std::vector<CellStress> stresses(mesh.cells.size(), {Vec3::Zero(), Vec3(q * kYield, 0.0, 0.0)});
    const SheetFlow flow = find_plastic_flow(*stiffness, mesh, stresses, {kYield, 0.26, 0.0});
    CAPTURE(q);
    CHECK(flow.greatest_stress == Approx(q * kYield));
    if (q < 1.0) {
      CHECK(flow.work == 0.0);
      continue;
    }
    // At s half thicknesses from the middle flow takes up (q^2 s^2 - 1) Y^2 / 6 G.
    const double unit = kYield / (6.0 * kShear);
    const double work =
        0.01 * kThickness * kYield * unit * (q * q / 3.0 * (1.0 - 1.0 / (q * q * q)) - (1.0 - 1.0 / q));
    const double curvature = 6.0 / kThickness * unit *
                             (0.25 * q * q * (1.0 - 1.0 / (q * q * q * q)) - 0.5 * (1.0 - 1.0 / (q * q)));
    CHECK(flow.work == Approx(work).epsilon(0.01));
    for (const SheetStrain& strain : flow.strains) {
      CHECK(strain.membrane.norm() < 1e-15);
      CHECK(strain.curvature(0) == Approx(curvature).epsilon(0.01));
      CHECK(strain.curvature(1) == Approx(-0.5 * curvature).epsilon(0.01));
    }
  }
}

TEST_CASE("shell yield: a sheet that is pulled flows as a solid does, and keeps its volume") {
  const Elements elements = grid(4, 4, 0.1, 0.1);
  const geometry::ShellMesh mesh = geometry::make_shell_mesh(elements);
  const auto stiffness = make_shell_stiffness(elements, {210e9, 0.3, 7850.0, 2e-3});
  const std::vector<CellStress> stresses(mesh.cells.size(), {Vec3(2.0 * 235e6, 0.0, 0.0), Vec3::Zero()});
  const SheetFlow flow = find_plastic_flow(*stiffness, mesh, stresses, {235e6, 0.26, 0.0});
  const double strain = 1.5 * 235e6 / (3.0 * 210e9 / 2.6);
  CHECK(flow.work == Approx(0.01 * 2e-3 * 235e6 * strain));
  CHECK(flow.volume == Approx(0.01 * 2e-3));
  for (const SheetStrain& s : flow.strains) {
    CHECK(s.membrane(0) == Approx(strain));
    CHECK(s.membrane(1) == Approx(-0.5 * strain));
    CHECK(equivalent_strain(s.membrane) == Approx(strain));
    CHECK(s.curvature.norm() < 1e-12);
  }
  // An impact that brings four times what the linear stress holds makes four times the flow.
  const double held = 0.01 * 2e-3 * 4.0 * 235e6 * 235e6 / (6.0 * 210e9 / 2.6);
  CHECK(find_plastic_flow(*stiffness, mesh, stresses, {235e6, 0.26, 4.0 * held}).work ==
        Approx(4.0 * flow.work));
}
