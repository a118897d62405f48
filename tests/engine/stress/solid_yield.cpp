// What flows and the shape that it leaves: strains that fit together come out as they are.
#include "engine/stress/solid_yield.h"

#include "engine/stress/solid_system.h"
#include "tests/engine/stress/solid_meshes.h"

using namespace shatterbox;
using namespace shatterbox::stress;
using namespace shatterbox::stress::testing;

using core::at;

TEST_CASE("a uniform plastic strain is the shape of a free solid, without stress and rigid motion") {
  const Solids solids = lattice_box(Vec3(0.5, 0.3, 0.2), 0.1);
  const geometry::SolidMesh mesh = make_solid_mesh(solids);
  const auto stiffness = make_solid_stiffness(solids, {210e9, 0.3, 7850.0});
  SolidStress strain;
  strain << 2e-3, -0.5e-3, -1.5e-3, 0.4e-3, -0.2e-3, 0.7e-3;
  const std::vector<SolidStress> strains(mesh.cells.size(), strain);
  const auto system = SolidSystem::make(stiffness, mesh).value();
  SolidSolveSettings settings;
  settings.tolerance = 1e-10;
  const SolidSolution shape = system->solve(eigenstrain_load(*stiffness, mesh, strains), settings);
  REQUIRE(shape.is_evaluated());
  Mat3 gradient;
  gradient << strain[0], strain[5], strain[4], strain[5], strain[1], strain[3], strain[4], strain[3],
      strain[2];
  // A free solid does not turn in the mean: what is left beside the strain is one rotation.
  std::vector<Vec3> places, rest;
  Mat3 second = Mat3::Zero();
  Vec3 turn = Vec3::Zero();
  for (std::size_t v = 0; v < mesh.vertex_source.size(); ++v) {
    const Vec3 x = mesh.elements->mesh.positions[at(mesh.vertex_source[v])];
    places.push_back(x);
    rest.push_back(Vec3(shape.displacement.segment<3>(static_cast<Eigen::Index>(3 * v))) - gradient * x);
    second += x.squaredNorm() * Mat3::Identity() - x * x.transpose();
    turn += x.cross(rest.back());
  }
  turn = second.inverse() * turn;
  double worst = 0.0;
  for (std::size_t v = 0; v < places.size(); ++v)
    worst = std::max(worst, (rest[v] - turn.cross(places[v])).norm());
  CHECK(worst < 1e-8);
}

TEST_CASE("flow begins at the yield strength and takes up the energy above it") {
  const Solids solids = lattice_box(Vec3(0.5, 0.3, 0.2), 0.1);
  const geometry::SolidMesh mesh = make_solid_mesh(solids);
  const auto stiffness = make_solid_stiffness(solids, {210e9, 0.3, 7850.0});
  const double shear = 210e9 / 2.6;
  SolidStress tension = SolidStress::Zero();
  for (const double over : {0.999, 1.5, 2.0}) {
    tension[0] = over * 235e6;
    const std::vector<SolidStress> stresses(mesh.cells.size(), tension);
    const PlasticFlow flow = find_plastic_flow(*stiffness, mesh, stresses, {235e6, 0.26, 0.0});
    CHECK(flow.greatest_stress == Approx(over * 235e6));
    // Energy of distortion above that at the yield strength, per volume: (s^2 - y^2) / 6 G.
    const double density = over > 1.0 ? (over * over - 1.0) * 235e6 * 235e6 / (6.0 * shear) : 0.0;
    double volume = 0.0;
    for (const auto& cell : mesh.cells) volume += cell.volume;
    CHECK(flow.work == Approx(density * volume).epsilon(1e-9));
    CHECK(flow.volume == Approx(over > 1.0 ? volume : 0.0));
    for (const SolidStress& strain : flow.strains) CHECK(std::abs(strain.head<3>().sum()) < 1e-15);
  }
}
