// The constant-strain tetrahedron: patch test, rigid motions, forces, derivatives, masses.
#include "engine/stress/solid_stiffness.h"

#include "tests/engine/stress/solid_meshes.h"

using namespace shatterbox;
using namespace shatterbox::stress;
using namespace shatterbox::stress::testing;

using core::at;
using std::size_t;

namespace {

Vec3 box_map(const Vec3& x) {
  return Vec3(2.0 * x.x(), 0.7 * x.y(), 1.1 * x.z()) - Vec3(1.0, 0.3, 0.5);
}

Solids distorted() {
  return mapped({4, 3, 3}, box_map, 0.35);
}

VecX displace(const geometry::SolidMesh& mesh, const std::function<Vec3(const Vec3&)>& motion) {
  VecX u(mesh.degree_of_freedom_count());
  for (size_t v = 0; v < mesh.vertex_source.size(); ++v)
    u.segment<3>(static_cast<Eigen::Index>(3 * v)) =
        motion(mesh.elements->mesh.positions[at(mesh.vertex_source[v])]);
  return u;
}

VecX random_displacement(const geometry::SolidMesh& mesh, double size) {
  core::Random random(3, 0);
  VecX u(mesh.degree_of_freedom_count());
  for (Eigen::Index i = 0; i < u.size(); ++i) u(i) = random.uniform(-size, size);
  return u;
}

/// The cut mesh beside the whole one.
std::vector<geometry::SolidMesh> meshes_of(const Solids& solids) {
  const geometry::SolidMesh whole = make_solid_mesh(solids);
  return {whole, cut_by_plane(whole, Vec3(1.0, 0.4, -0.3), 0.0312).mesh};
}

SolidStress hooke(const Mat3& gradient, const SolidProperties& properties) {
  const double e = properties.youngs_modulus, nu = properties.poisson_ratio;
  const Mat3 strain = 0.5 * (gradient + gradient.transpose());
  const Mat3 s = e / (1.0 + nu) * (strain + nu / (1.0 - 2.0 * nu) * strain.trace() * Mat3::Identity());
  SolidStress stress;
  stress << s(0, 0), s(1, 1), s(2, 2), s(1, 2), s(2, 0), s(0, 1);
  return stress;
}

}  // namespace

TEST_CASE("solid patch test: a linear displacement gives one stress and no force inside") {
  const Solids solids = distorted();
  const SolidProperties properties = solid_properties(0.27);
  const auto stiffness = make_solid_stiffness(solids, properties);
  Mat3 gradient;
  gradient << 1e-3, 2e-4, -3e-4, 5e-4, -7e-4, 1e-4, 2e-4, 9e-4, 4e-4;
  const SolidStress expected = hooke(gradient, properties);
  for (const geometry::SolidMesh& mesh : meshes_of(solids)) {
    const VecX u = displace(mesh, [&](const Vec3& x) -> Vec3 { return gradient * x + Vec3(1.0, 2.0, 3.0); });
    for (const SolidStress& stress : cell_stresses(*stiffness, mesh, u))
      CHECK(stress_norm(stress - expected) < 1e-12 * 1e4 * stress_norm(expected));  // 1e4: the shift's digits
    const VecX v = displace(mesh, [&](const Vec3& x) -> Vec3 { return gradient * x; });
    for (const SolidStress& stress : cell_stresses(*stiffness, mesh, v))
      CHECK(stress_norm(stress - expected) < 1e-12 * stress_norm(expected));
  }
  const geometry::SolidMesh mesh = make_solid_mesh(solids);
  const VecX u = displace(mesh, [&](const Vec3& x) -> Vec3 { return gradient * x; });
  const VecX force = apply_stiffness(*stiffness, mesh, u);
  const double scale = force.cwiseAbs().maxCoeff();
  int inside = 0;
  for (size_t v = 0; v < mesh.vertex_source.size(); ++v) {
    const Vec3& x = solids->mesh.positions[v];
    if (std::abs(x.x()) > 0.99 || x.y() < -0.29 || x.y() > 0.39 || x.z() < -0.49 || x.z() > 0.59) continue;
    ++inside;
    CHECK(force.segment<3>(static_cast<Eigen::Index>(3 * v)).norm() < 1e-12 * scale);
  }
  CHECK(inside == 12);
}

TEST_CASE("a solid's rigid motions cost no force, whole and cut") {
  const Solids solids = distorted();
  const auto stiffness = make_solid_stiffness(solids, solid_properties());
  for (const geometry::SolidMesh& mesh : meshes_of(solids)) {
    const VecX random = random_displacement(mesh, 1.0);
    const double scale = apply_stiffness(*stiffness, mesh, random).norm() / random.norm();
    for (int i = 0; i < 6; ++i) {
      const VecX u = displace(mesh, [&](const Vec3& x) -> Vec3 {
        return i < 3 ? Vec3(Vec3::Unit(i)) : Vec3(Vec3::Unit(i - 3).cross(x));
      });
      CHECK(apply_stiffness(*stiffness, mesh, u).norm() < 1e-13 * scale * u.norm());
    }
    const auto system = make_solid_system(stiffness, mesh);
    CHECK(system->part_count() == (mesh.cells.size() > solids->mesh.tetrahedra.size() ? 2 : 1));
    CHECK(system->rigid_mode_count() == 6 * system->part_count());
  }
}

TEST_CASE("linearised strain sees a finite rotation as stretching, an infinitesimal one not at all") {
  const Solids solids = distorted();
  const SolidProperties properties = solid_properties();
  const auto stiffness = make_solid_stiffness(solids, properties);
  const geometry::SolidMesh mesh = make_solid_mesh(solids);
  const double angle = 0.5;
  const Vec3 axis = Vec3(1.0, 2.0, -1.0).normalized();
  const VecX linear = displace(mesh, [&](const Vec3& x) -> Vec3 { return angle * axis.cross(x); });
  for (const SolidStress& stress : cell_stresses(*stiffness, mesh, linear))
    CHECK(stress_norm(stress) < 1e-13 * properties.youngs_modulus);
  // [BHTF07] Fig. 7: R - I has the symmetric part (cos - 1)(I - n n^T).
  const Mat3 turned = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
  const VecX finite = displace(mesh, [&](const Vec3& x) -> Vec3 { return turned * x - x; });
  const SolidStress expected =
      hooke((core::cos(angle) - 1.0) * (Mat3::Identity() - axis * axis.transpose()), properties);
  for (const SolidStress& stress : cell_stresses(*stiffness, mesh, finite))
    CHECK(stress_norm(stress - expected) < 1e-12 * stress_norm(expected));
}

TEST_CASE("forces are P B_m, as the paper has them, and minus the stiffness times the displacement") {
  const Solids solids = distorted();
  const auto stiffness = make_solid_stiffness(solids, solid_properties(0.2));
  const geometry::SolidMesh mesh = make_solid_mesh(solids);
  const VecX u = random_displacement(mesh, 1e-3);
  const auto stresses = cell_stresses(*stiffness, mesh, u);
  VecX force = VecX::Zero(u.size());
  for (size_t c = 0; c < mesh.cells.size(); ++c) {
    const auto& v = mesh.cells[c].vertices;
    Mat3 dm;
    for (int i = 0; i < 3; ++i)
      dm.col(i) = solids->mesh.positions[at(v[at(i + 1)])] - solids->mesh.positions[at(v[0])];
    // -1/6 cofactor(Dm): the outward areas of the faces at corner 0, a third each.
    const Mat3 bm = -1.0 / 6.0 * dm.determinant() * dm.inverse().transpose();
    const Mat3 f = stress_tensor(stresses[c]) * bm;
    for (int i = 0; i < 3; ++i) force.segment<3>(3 * v[at(i + 1)]) += f.col(i);
    force.segment<3>(3 * v[0]) -= f.rowwise().sum();
  }
  CHECK((force + apply_stiffness(*stiffness, mesh, u)).norm() < 1e-13 * force.norm());
}

TEST_CASE("a solid's stiffness is the derivative of its energy, and symmetric") {
  const Solids solids = mapped({2, 2, 1}, box_map, 0.0);
  const SolidProperties properties = solid_properties(0.25);
  const auto stiffness = make_solid_stiffness(solids, properties);
  for (const geometry::SolidMesh& mesh : meshes_of(solids)) {
    const VecX u = random_displacement(mesh, 1e-3);
    // Half of stress times strain over the stiff volume.
    const auto energy_of = [&](const VecX& w) {
      const auto stresses = cell_stresses(*stiffness, mesh, w);
      double energy = 0.0;
      for (size_t c = 0; c < stresses.size(); ++c) {
        const Mat3 s = stress_tensor(stresses[c]);
        const double volume = stiffness_fraction(*stiffness, mesh.cells[c]) *
                              geometry::tetrahedron_volume(solids->mesh, mesh.cells[c].element);
        energy += 0.5 * volume / properties.youngs_modulus *
                  ((1.0 + 0.25) * (s * s).trace() - 0.25 * s.trace() * s.trace());
      }
      return energy;
    };
    const VecX force = apply_stiffness(*stiffness, mesh, u);
    CHECK(0.5 * u.dot(force) == Approx(energy_of(u)).epsilon(1e-12));
    const double step = 1e-5;
    for (Eigen::Index i = 0; i < u.size(); ++i) {
      VecX up = u, down = u;
      up(i) += step;
      down(i) -= step;
      const double slope = (energy_of(up) - energy_of(down)) / (2.0 * step);
      CHECK(std::abs(slope - force(i)) < 1e-8 * force.cwiseAbs().maxCoeff());
    }
    const VecX w = random_displacement(mesh, 1.0).reverse();
    CHECK(w.dot(force) == Approx(u.dot(apply_stiffness(*stiffness, mesh, w))).epsilon(1e-12));
  }
}

TEST_CASE("a solid's lumped mass has the material's mass and centre, whole and cut") {
  const Solids solids = distorted();
  const auto stiffness = make_solid_stiffness(solids, solid_properties());
  for (const geometry::SolidMesh& mesh : meshes_of(solids)) {
    const VecX mass = lumped_mass(*stiffness, mesh);
    double sum = 0.0, expected = 0.0;
    Vec3 moment = Vec3::Zero(), expected_moment = Vec3::Zero();
    for (size_t v = 0; v < mesh.vertex_source.size(); ++v) {
      const double m = mass(static_cast<Eigen::Index>(3 * v));
      CHECK(m > 0.0);
      sum += m;
      moment += m * solids->mesh.positions[at(mesh.vertex_source[v])];
    }
    for (const geometry::SolidCell& cell : mesh.cells) {
      expected += 1200.0 * cell.volume;
      expected_moment += 1200.0 * cell.volume * cell_centroid(mesh, cell);
    }
    CHECK(expected == Approx(1200.0 * 2.0 * 0.7 * 1.1).epsilon(1e-12));
    CHECK(sum == Approx(expected).epsilon(1e-12));
    // Slivers keep a thousandth at each corner.
    CHECK((moment - expected_moment).norm() < 1e-6 * expected);
  }
}

TEST_CASE("Poisson's ratio of a solid is clamped, and said to be") {
  const Solids solids = distorted();
  const auto soft = make_solid_stiffness(solids, solid_properties(0.49));
  CHECK(soft->is_poisson_clamped());
  CHECK(soft->poisson_ratio == 0.40);
  CHECK_FALSE(make_solid_stiffness(solids, solid_properties(0.40))->is_poisson_clamped());
}

TEST_CASE("a sliver of a solid is softened, one without volume carries nothing") {
  for (const double height : {1e-2, 1e-5, 1e-9, 0.0}) {
    geometry::TetMesh mesh;
    mesh.positions = {
        {0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.3, 0.3, height}, {0.2, 0.2, -1.0}};
    mesh.tetrahedra = {{0, 1, 2, 3}, {0, 2, 1, 4}};
    const auto stiffness = make_solid_stiffness(make_solids(mesh), solid_properties());
    const SolidElement& sliver = stiffness->solids[0];
    double stiffest = 0.0;
    for (const Vec3& g : sliver.gradients)
      stiffest = std::max(stiffest, sliver.modulus * sliver.volume * g.squaredNorm());
    CHECK(std::isfinite(stiffest));
    // As stiff as one of a thousandth of its edge: 0.5 m2 of area over that height, in units of the solid.
    CHECK(stiffest < 1.01 * (0.5 / 1e-3) / stiffness->length);
    CHECK((sliver.modulus == 1.0) == (height == 1e-2));
    CHECK((sliver.modulus == 0.0) == (height == 0.0));
  }
}
