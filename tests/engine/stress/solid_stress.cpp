// Principal axes, averages and fits of a solid's stress.
#include "engine/stress/solid_stress.h"

#include <Eigen/Eigenvalues>

#include "tests/engine/stress/solid_meshes.h"

using namespace shatterbox;
using namespace shatterbox::stress;
using namespace shatterbox::stress::testing;

using core::at;
using std::size_t;

namespace {

SolidStress random_stress(core::Random& random) {
  SolidStress stress;
  for (int i = 0; i < 6; ++i) stress(i) = random.uniform(-1.0, 1.0);
  return stress;
}

void check_axes(const Mat3& tensor, double tolerance) {
  const PrincipalAxes axes = find_principal_axes(tensor);
  const double size = tensor.norm();
  CHECK(axes.values(0) >= axes.values(1));
  CHECK(axes.values(1) >= axes.values(2));
  CHECK((axes.directions.transpose() * axes.directions - Mat3::Identity()).norm() < tolerance);
  CHECK(axes.directions.determinant() == Approx(1.0));
  CHECK((tensor * axes.directions - axes.directions * axes.values.asDiagonal()).norm() <= tolerance * size);
}

}  // namespace

TEST_CASE("principal axes: random tensors, as another method has them") {
  core::Random random(1, 0);
  for (int i = 0; i < 2000; ++i) {
    const Mat3 tensor = stress_tensor(random_stress(random));
    check_axes(tensor, 1e-14);
    const Vec3 other = Eigen::SelfAdjointEigenSolver<Mat3>(tensor).eigenvalues();
    CHECK((find_principal_axes(tensor).values.reverse() - other).norm() < 1e-14);
  }
}

TEST_CASE("principal axes: values that are one, scales apart, nothing") {
  core::Random random(2, 0);
  for (const Vec3& values : {Vec3(1.0, 1.0, -2.0), Vec3(3.0, -1.0, -1.0), Vec3(2.0, 2.0, 2.0),
                             Vec3(1.0, 1e-9, 0.0), Vec3(1.0, 1.0 - 1e-13, 0.5), Vec3(1e8, 1.0, 1e-8),
                             Vec3(0.0, 0.0, 0.0), Vec3(1e300, 3e298, -1e299), Vec3(1e-300, 0.0, -1e-301)})
    for (int i = 0; i < 50; ++i) {
      const Vec3 axis = Vec3(random.normal(), random.normal(), random.normal()).normalized();
      const Mat3 turn = Eigen::AngleAxisd(random.uniform(0.0, 6.0), axis).toRotationMatrix();
      const double scale = std::max(values.cwiseAbs().maxCoeff(), 1e-300);
      const Mat3 tensor = turn * (values / scale).asDiagonal() * turn.transpose();
      check_axes(0.5 * (tensor + tensor.transpose()), 1e-14);
      CHECK((find_principal_axes(scale * tensor).values / scale - values / scale).norm() < 1e-14);
    }
  CHECK(find_principal_axes(Mat3(Vec3(1.0, 3.0, 2.0).asDiagonal())).values == Vec3(3.0, 2.0, 1.0));
}

TEST_CASE("a solid's stress: tensor, norm, von Mises") {
  SolidStress uniaxial = SolidStress::Zero();
  uniaxial(1) = 5.0;
  CHECK(von_mises(uniaxial) == Approx(5.0));
  CHECK(stress_norm(uniaxial) == Approx(5.0));
  SolidStress shear = SolidStress::Zero();
  shear(4) = 2.0;
  CHECK(von_mises(shear) == Approx(2.0 * core::sqrt(3.0)));
  CHECK(stress_tensor(shear)(0, 2) == 2.0);
  CHECK(stress_tensor(shear)(2, 0) == 2.0);
  SolidStress pressure = SolidStress::Zero();
  pressure.head<3>().setConstant(-7.0);
  CHECK(von_mises(pressure) == 0.0);
  core::Random random(3, 0);
  for (int i = 0; i < 100; ++i) {
    const SolidStress stress = random_stress(random);
    CHECK(principal_axes(stress).values.cwiseAbs().maxCoeff() <= stress_norm(stress) * (1.0 + 1e-15));
    const Vec3 s = principal_axes(stress).values;
    CHECK(most_tension(stress) >= s(0));
    CHECK(most_tension(stress) <= s(0) + 0.334 * von_mises(stress));
    CHECK(von_mises(stress) ==
          Approx(core::sqrt(0.5 * ((s(0) - s(1)) * (s(0) - s(1)) + (s(1) - s(2)) * (s(1) - s(2)) +
                                   (s(2) - s(0)) * (s(2) - s(0))))));
  }
}

TEST_CASE(
    "a solid's stress fits are exact where the stress is linear, whole and cut, and averages are theirs") {
  const Solids solids = mapped(
      {5, 4, 4}, [](const Vec3& x) -> Vec3 { return x.cwiseProduct(Vec3(2.0, 1.0, 0.8)); }, 0.3);
  core::Random random(4, 0);
  const SolidStress base = random_stress(random);
  const std::array<SolidStress, 3> slope{random_stress(random), random_stress(random), random_stress(random)};
  const auto field = [&](const Vec3& x) {
    return SolidStress(base + x.x() * slope[0] + x.y() * slope[1] + x.z() * slope[2]);
  };
  const geometry::SolidMesh whole = make_solid_mesh(solids);
  CutSolid cut = cut_by_plane(whole, Vec3(1.0, 0.3, -0.2), 0.913);
  for (const auto& [mesh, contacts] :
       {std::pair{whole, whole_contacts(whole)}, std::pair{cut.mesh, cut.contacts}}) {
    std::vector<SolidStress> stresses;
    for (const geometry::SolidCell& cell : mesh.cells) stresses.push_back(field(cell_centroid(mesh, cell)));
    const auto fits = fit_stresses(mesh, contacts, stresses);
    const auto means = average_stresses(mesh, contacts, stresses);
    int sloped = 0;
    for (size_t c = 0; c < fits.size(); ++c) {
      CHECK(stress_norm(fits[c].mean - field(fits[c].centre)) < 1e-12);
      CHECK(stress_norm(fits[c].mean - means[c]) < 1e-12);
      if (fits[c].slope[0].isZero(0.0)) continue;  // a border cell with too few neighbours
      ++sloped;
      CHECK(stress_norm(fits[c].at(Vec3(0.3, 0.2, 0.1)) - field(Vec3(0.3, 0.2, 0.1))) < 1e-9);
    }
    CHECK(sloped > static_cast<int>(fits.size()) / 2);
  }
}

TEST_CASE("a solid's stress is not averaged across a crack") {
  const Solids solids = lattice_box(Vec3(0.5, 0.5, 0.5), 0.25);
  const CutSolid cut = cut_by_plane(make_solid_mesh(solids), Vec3(1.0, 0.2, 0.1), 0.03);
  std::vector<SolidStress> stresses;
  const auto is_behind = [&](size_t c) {
    return Vec3(1.0, 0.2, 0.1).dot(cell_centroid(cut.mesh, cut.mesh.cells[c])) < 0.03;
  };
  for (size_t c = 0; c < cut.mesh.cells.size(); ++c)
    stresses.push_back(is_behind(c) ? SolidStress(SolidStress::Zero()) : SolidStress(SolidStress::Ones()));
  for (const auto& means = average_stresses(cut.mesh, cut.contacts, stresses); const auto& mean : means)
    CHECK((mean.isZero(0.0) || mean.isApprox(SolidStress::Ones(), 1e-14)));
  const auto twice = combine_stresses({stresses, stresses}, {0.5, 1.5});
  for (size_t c = 0; c < twice.size(); ++c) CHECK(twice[c] == 2.0 * stresses[c]);
}
