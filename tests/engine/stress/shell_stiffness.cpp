// The element: patch tests, rigid motions, mechanisms (NUMERICS cases 1, 2, 3 and the table of zero modes).
#include "engine/stress/shell_stiffness.h"

#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>

#include "engine/stress/shell_stress.h"
#include "tests/engine/stress/meshes.h"

using namespace shatterbox;
using namespace shatterbox::stress;
using namespace shatterbox::stress::testing;

namespace {

/// A plate folded out of its plane and turned, so that nothing is aligned with an axis.
Elements turned_plate(double jitter) {
  geometry::TriangleMesh mesh = grid_mesh(6, 5, 1.2, 1.0, jitter);
  const Mat3 turn = (Quat(0.9, 0.2, -0.3, 0.25).normalized()).toRotationMatrix();
  for (Vec3& position : mesh.positions) position = turn * position;
  return make_elements(std::move(mesh));
}

int zero_modes(const Elements& elements, const ShellProperties& properties) {
  const auto stiffness = make_shell_stiffness(elements, properties);
  const geometry::ShellMesh mesh = geometry::make_shell_mesh(elements);
  const int count = properties.has_bending ? mesh.degree_of_freedom_count()
                                           : 3 * static_cast<int>(mesh.vertex_source.size());
  Eigen::MatrixXd dense(count, count);
  for (int i = 0; i < count; ++i)
    dense.col(i) =
        apply_stiffness(*stiffness, mesh, VecX::Unit(mesh.degree_of_freedom_count(), i)).head(count);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(dense, Eigen::EigenvaluesOnly);
  return static_cast<int>((eigen.eigenvalues().array() < 1e-11 * eigen.eigenvalues().maxCoeff()).count());
}

double norm_of_stiffness(const ShellStiffness& stiffness, const geometry::ShellMesh& mesh) {
  VecX probe(mesh.degree_of_freedom_count());
  core::Random random(3, 0);
  for (Eigen::Index i = 0; i < probe.size(); ++i) probe(i) = random.uniform(-1.0, 1.0);
  return apply_stiffness(stiffness, mesh, probe).norm();
}

}  // namespace

TEST_CASE("membrane patch test: a linear displacement gives one stress, and no force inside") {
  const Elements elements = turned_plate(0.3);
  ShellProperties properties;
  properties.youngs_modulus = 3e9;
  properties.poisson_ratio = 0.3;
  properties.thickness = 0.02;
  const auto stiffness = make_shell_stiffness(elements, properties);
  const geometry::ShellMesh mesh = geometry::make_shell_mesh(elements);
  const Mat3 frame = geometry::facet_frame(*elements, 0);
  const double exx = 1e-4, eyy = -3e-5, exy = 2e-5;
  VecX u = VecX::Zero(mesh.degree_of_freedom_count());
  for (std::size_t v = 0; v < elements->mesh.positions.size(); ++v) {
    const Vec3& x = elements->mesh.positions[v];
    const double px = frame.col(0).dot(x), py = frame.col(1).dot(x);
    u.segment<3>(vertex_dof(static_cast<int>(v))) =
        (exx * px + exy * py) * frame.col(0) + (exy * px + eyy * py) * frame.col(1);
  }
  const double factor = properties.youngs_modulus / (1.0 - 0.09);
  Mat2 expected;
  expected << factor * (exx + 0.3 * eyy), factor * 0.7 * exy, factor * 0.7 * exy, factor * (eyy + 0.3 * exx);
  const auto stresses = cell_stresses(*stiffness, mesh, u);
  for (std::size_t c = 0; c < stresses.size(); ++c) {
    // Each facet has its own axes in the plane.
    const Mat3 own = geometry::facet_frame(*elements, static_cast<int>(c));
    const Mat2 turn = frame.leftCols<2>().transpose() * own.leftCols<2>();
    const Mat2 local = turn.transpose() * expected * turn;
    const PlaneStress want(local(0, 0), local(1, 1), local(0, 1));
    REQUIRE((stresses[c].membrane - want).norm() < 1e-11 * want.norm());
    REQUIRE(stresses[c].bending.norm() < 1e-9 * want.norm());
  }
  const VecX force = apply_stiffness(*stiffness, mesh, u);
  const double scale = expected.norm() * properties.thickness * 0.2;
  for (int j = 1; j < 5; ++j)
    for (int i = 1; i < 6; ++i) REQUIRE(force.segment<3>(vertex_dof(j * 7 + i)).norm() < 1e-12 * scale);
}

TEST_CASE(
    "Morley patch test: a quadratic deflection gives one curvature on a distorted mesh, and no force "
    "inside") {
  const Elements elements = grid(6, 6, 1.0, 1.0, 0.35);
  ShellProperties properties;
  properties.thickness = 0.01;
  const auto stiffness = make_shell_stiffness(elements, properties);
  const geometry::ShellMesh mesh = geometry::make_shell_mesh(elements);
  const double a = 0.3, b = -0.2, c = 0.15;  // w = a x^2 + b y^2 + c x y
  VecX u = VecX::Zero(mesh.degree_of_freedom_count());
  const auto& positions = elements->mesh.positions;
  for (std::size_t v = 0; v < positions.size(); ++v) {
    const Vec3& x = positions[v];
    u(vertex_dof(static_cast<int>(v)) + 2) = a * x.x() * x.x() + b * x.y() * x.y() + c * x.x() * x.y();
  }
  for (std::size_t e = 0; e < elements->topology.edges.size(); ++e) {
    const auto& ends = elements->topology.edges[e];
    const Vec3& p = positions[static_cast<std::size_t>(ends[0])];
    const Vec3& q = positions[static_cast<std::size_t>(ends[1])];
    const Vec3 middle = 0.5 * (p + q);
    const Vec3 slope(2 * a * middle.x() + c * middle.y(), 2 * b * middle.y() + c * middle.x(), 0.0);
    // The normal that follows the surface turns by -n x grad w.
    u(edge_dof(mesh, static_cast<int>(e))) = -Vec3::UnitZ().cross(slope).dot((q - p).normalized());
  }
  const double nu = properties.poisson_ratio;
  const double factor = -0.5 * properties.thickness * properties.youngs_modulus / (1.0 - nu * nu);
  Mat2 expected;
  expected << 2 * a + nu * 2 * b, (1 - nu) * c, (1 - nu) * c, 2 * b + nu * 2 * a;
  expected *= factor;
  const auto stresses = cell_stresses(*stiffness, mesh, u);
  for (std::size_t cell = 0; cell < stresses.size(); ++cell) {
    const Mat2 turn = geometry::facet_frame(*elements, static_cast<int>(cell)).topLeftCorner<2, 2>();
    const Mat2 local = turn.transpose() * expected * turn;
    const PlaneStress want(local(0, 0), local(1, 1), local(0, 1));
    REQUIRE((stresses[cell].bending - want).norm() < 1e-12 * expected.norm());
  }
  const VecX force = apply_stiffness(*stiffness, mesh, u);
  const double scale = force.cwiseAbs().maxCoeff();
  for (int j = 1; j < 6; ++j)
    for (int i = 1; i < 6; ++i) REQUIRE(std::abs(force(vertex_dof(j * 7 + i) + 2)) < 1e-11 * scale);
}

TEST_CASE("rigid motions make no force, on folded shells too, edge rotations included") {
  for (const Elements& elements : {icosphere(1), turned_plate(0.2)}) {
    ShellProperties properties;
    properties.thickness = 0.03;
    const auto stiffness = make_shell_stiffness(elements, properties);
    const geometry::ShellMesh mesh = geometry::make_shell_mesh(elements);
    const double norm = norm_of_stiffness(*stiffness, mesh);
    for (int axis = 0; axis < 3; ++axis) {
      VecX shift = VecX::Zero(mesh.degree_of_freedom_count());
      VecX turn = shift;
      for (int v = 0; v < static_cast<int>(mesh.vertex_source.size()); ++v) {
        shift(vertex_dof(v) + axis) = 1.0;
        turn.segment<3>(vertex_dof(v)) =
            Vec3::Unit(axis).cross(elements->mesh.positions[static_cast<std::size_t>(v)]);
      }
      for (int e = 0; e < static_cast<int>(mesh.edge_source.size()); ++e) {
        const auto& ends = elements->topology.edges[static_cast<std::size_t>(e)];
        turn(edge_dof(mesh, e)) = (elements->mesh.positions[static_cast<std::size_t>(ends[1])] -
                                   elements->mesh.positions[static_cast<std::size_t>(ends[0])])
                                      .normalized()(axis);
      }
      REQUIRE(apply_stiffness(*stiffness, mesh, shift).norm() < 1e-13 * norm);
      REQUIRE(apply_stiffness(*stiffness, mesh, turn).norm() < 1e-13 * norm);
    }
  }
}

TEST_CASE("zero modes: six with bending, six for a closed membrane, many for an open one") {
  ShellProperties bending;
  bending.thickness = 0.05;
  ShellProperties membrane = bending;
  membrane.has_bending = false;
  const Elements sphere = icosphere(1);
  REQUIRE(zero_modes(sphere, bending) == 6);
  REQUIRE(zero_modes(sphere, membrane) == 6);
  const Elements pane = grid(4, 4, 1.0, 1.0);
  REQUIRE(zero_modes(pane, bending) == 6);
  REQUIRE(zero_modes(pane, membrane) == 25 + 3);  // a deflection of every vertex, and three in the plane
}

TEST_CASE("lumped mass: total mass and centre of mass, of cut shells too") {
  const Elements elements = grid(5, 4, 1.0, 0.8, 0.3);
  ShellProperties properties;
  const auto stiffness = make_shell_stiffness(elements, properties);
  const geometry::ShellMesh whole = geometry::make_shell_mesh(elements);
  for (const geometry::ShellMesh& mesh : {whole, cut_between(whole, 0.4637)}) {
    const VecX mass = lumped_mass(*stiffness, mesh);
    double sum = 0.0;
    Vec3 moment = Vec3::Zero();
    for (std::size_t v = 0; v < mesh.vertex_source.size(); ++v) {
      const double m = mass(vertex_dof(static_cast<int>(v)));
      sum += m;
      moment += m * elements->mesh.positions[static_cast<std::size_t>(mesh.vertex_source[v])];
    }
    REQUIRE(sum == Approx(0.8 * properties.thickness * properties.density).epsilon(1e-12));
    REQUIRE((moment / sum - Vec3(0.5, 0.4, 0.0)).norm() < 2e-5);  // slivers' least weights move it a little
    REQUIRE(mass.minCoeff() > 0.0);
  }
}
