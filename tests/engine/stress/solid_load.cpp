// Loads of solids: patches, groups of a cracked patch, spin.
#include "engine/stress/solid_load.h"

#include <set>

#include "engine/core/random.h"
#include "engine/geometry/closest_points.h"
#include "tests/engine/stress/solid_meshes.h"

using namespace shatterbox;
using namespace shatterbox::stress;
using namespace shatterbox::stress::testing;

using core::at;
using std::size_t;

namespace {

Vec3 resultant(const VecX& load) {
  Vec3 sum = Vec3::Zero();
  for (Eigen::Index i = 0; i < load.size(); i += 3) sum += load.segment<3>(i);
  return sum;
}

Vec3 moment(const geometry::SolidMesh& mesh, const VecX& load) {
  Vec3 sum = Vec3::Zero();
  for (size_t v = 0; v < mesh.vertex_source.size(); ++v)
    sum += mesh.elements->mesh.positions[at(mesh.vertex_source[v])].cross(
        Vec3(load.segment<3>(static_cast<Eigen::Index>(3 * v))));
  return sum;
}

}  // namespace

TEST_CASE("a solid's load patch is a paraboloid about the nearest point of the skin") {
  const Solids solids = lattice_box(Vec3(0.5, 0.5, 0.5), 0.05);
  const geometry::SolidMesh mesh = make_solid_mesh(solids);
  const SolidSkin skin = make_border_skin(mesh);
  CHECK(skin.cells.size() == skin.mesh.triangles.size());
  const Vec3 force(1.0, -2.0, -3.0);
  for (const double radius : {0.2, 0.1, 0.03}) {
    const SolidPatch patch = find_load_patch(mesh, skin, Vec3(0.11, -0.07, 0.9), radius);
    CHECK((patch.centre - Vec3(0.11, -0.07, 0.5)).norm() < 1e-15);
    CHECK((patch.normal - Vec3::UnitZ()).norm() < 1e-15);
    double sum = 0.0;
    for (const SolidPatchShare& share : patch.shares) {
      sum += share.weight;
      CHECK(share.corner_weights.sum() == Approx(1.0));
      CHECK(share.corner_weights.minCoeff() > -1e-12);
      // On the skin: the corner opposite takes nothing.
      CHECK(std::abs(share.corner_weights.minCoeff()) < 1e-12);
    }
    CHECK(sum == Approx(1.0).epsilon(1e-14));
    const VecX load = patch_load(mesh, patch, force);
    CHECK((resultant(load) - force).norm() < 1e-13);
    // The paraboloid's centre is the patch's, as far as the quadrature tells.
    CHECK((moment(mesh, load) - patch.centre.cross(force)).norm() < 0.02 * radius * force.norm());
  }
  // Second moment of the paraboloid: radius^2 / 3 in all; the nodes carry h^2 / 12 or so more.
  const SolidPatch patch = find_load_patch(mesh, skin, Vec3(0.0, 0.0, 0.5), 0.4);
  const VecX load = patch_load(mesh, patch, Vec3(0.0, 0.0, 1.0));
  double second = 0.0;
  for (size_t v = 0; v < mesh.vertex_source.size(); ++v)
    second += load(static_cast<Eigen::Index>(3 * v + 2)) * solids->mesh.positions[v].head<2>().squaredNorm();
  CHECK(second == Approx(0.16 / 3.0).epsilon(0.03));
}

TEST_CASE("a solid's load patch is about the nearest of all points of a skin of many blocks") {
  const Solids solids = lattice_box(Vec3(0.5, 0.4, 0.3), 0.06);
  const geometry::SolidMesh mesh = make_solid_mesh(solids);
  const SolidSkin skin = make_border_skin(mesh);
  REQUIRE(skin.blocks.size() == (skin.cells.size() + SolidSkin::kBlock - 1) / SolidSkin::kBlock);
  REQUIRE(skin.blocks.size() > 20);
  core::Random random(7);
  for (int i = 0; i < 200; ++i) {
    const Vec3 point(random.uniform(-0.7, 0.7), random.uniform(-0.7, 0.7), random.uniform(-0.7, 0.7));
    double least = 1e300;
    size_t nearest = 0;
    for (size_t t = 0; t < skin.cells.size(); ++t) {
      const geometry::Triangle& corners = skin.mesh.triangles[t];
      const auto found = geometry::closest_on_triangle(point, skin.mesh.positions[at(corners[0])],
                                                       skin.mesh.positions[at(corners[1])],
                                                       skin.mesh.positions[at(corners[2])]);
      if (!(found.distance < least)) continue;
      least = found.distance;
      nearest = t;
    }
    const SolidPatch patch = find_load_patch(mesh, skin, point, 0.1);
    CHECK((patch.centre - point).norm() == Approx(least));
    CHECK(patch.nearest_cell == skin.cells[nearest]);
  }
}

TEST_CASE("a solid's patch: all on one point if it is small, round an edge, never through a wall") {
  const Solids solids = lattice_box(Vec3(0.5, 0.5, 0.05), 0.05);
  const geometry::SolidMesh mesh = make_solid_mesh(solids);
  const SolidSkin skin = make_border_skin(mesh);
  for (const double radius : {0.0, 1e-9}) {
    const SolidPatch point = find_load_patch(mesh, skin, Vec3(0.012, 0.03, 0.05), radius);
    CHECK(point.shares.size() <= 2);
    CHECK((resultant(patch_load(mesh, point, Vec3::UnitX())) - Vec3::UnitX()).norm() < 1e-14);
  }
  const SolidPatch wide = find_load_patch(mesh, skin, Vec3(0.0, 0.0, 0.05), 0.3);
  for (const SolidPatchShare& share : wide.shares)
    for (int i = 0; i < 4; ++i)
      if (share.corner_weights(i) > 1e-9)
        CHECK(solids->mesh.positions[at(mesh.cells[at(share.cell)].vertices[at(i)])].z() == 0.05);
}

TEST_CASE("a solid's cracked patch falls into groups that share the load") {
  const Solids solids = lattice_box(Vec3(0.5, 0.5, 0.5), 0.1);
  const geometry::SolidMesh whole = make_solid_mesh(solids);
  const SolidSkin skin = make_border_skin(whole);
  const SolidPatch patch = find_load_patch(whole, skin, Vec3(0.0, 0.0, 0.5), 0.25);
  const auto one = group_patch(whole, patch);
  for (const int group : one) CHECK(group == 0);
  CHECK(group_weight(patch, one, 0) == Approx(1.0));

  // Cut by a plane through the patch; the skin's cut triangles go to the cell that has more of them.
  const Vec3 normal = Vec3(1.0, 0.1, 0.0);
  const CutSolid cut = cut_by_plane(whole, normal, 0.03);
  SolidSkin cut_skin;
  cut_skin.mesh.positions = skin.mesh.positions;
  for (size_t t = 0; t < skin.cells.size(); ++t) {
    Vec3 centre = Vec3::Zero();
    for (const int v : skin.mesh.triangles[t]) centre += skin.mesh.positions[at(v)] / 3.0;
    const bool is_ahead = normal.dot(centre) > 0.03;
    int cell = -1;
    for (size_t c = 0; c < cut.mesh.cells.size(); ++c)
      if (cut.mesh.cells[c].element == skin.cells[t] &&
          (normal.dot(cell_centroid(cut.mesh, cut.mesh.cells[c])) > 0.03) == is_ahead)
        cell = static_cast<int>(c);
    REQUIRE(cell >= 0);
    cut_skin.add(skin.mesh.triangles[t], cell);
  }
  const SolidPatch cracked = find_load_patch(cut.mesh, cut_skin, Vec3(0.0, 0.0, 0.5), 0.25);
  const auto groups = group_patch(cut.mesh, cracked);
  CHECK(std::set<int>(groups.begin(), groups.end()) == std::set<int>{0, 1});
  CHECK(group_weight(cracked, groups, 0) + group_weight(cracked, groups, 1) == Approx(1.0));
  const VecX first = group_load(cut.mesh, cracked, groups, 0, Vec3::UnitZ());
  const VecX second = group_load(cut.mesh, cracked, groups, 1, Vec3::UnitZ());
  CHECK((resultant(first) - Vec3::UnitZ()).norm() < 1e-14);
  CHECK(first.cwiseProduct(second).isZero(0.0));
  const VecX both = group_weight(cracked, groups, 0) * first + group_weight(cracked, groups, 1) * second;
  CHECK((both - patch_load(cut.mesh, cracked, Vec3::UnitZ())).norm() < 1e-14);
}

TEST_CASE("the load of a solid's spin: resultant and moment of the material, whole and cut") {
  const Solids solids = lattice_box(Vec3(0.5, 0.3, 0.2), 0.1);
  const geometry::SolidMesh whole = make_solid_mesh(solids);
  const auto stiffness = make_solid_stiffness(solids, solid_properties());
  const Vec3 spin(3.0, -2.0, 5.0), about(0.2, 0.1, -0.3);
  const double mass = 1200.0 * 0.24;
  for (const geometry::SolidMesh& mesh : {whole, cut_by_plane(whole, Vec3(1.0, 0.3, 0.2), 0.11).mesh}) {
    const VecX load = centrifugal_load(*stiffness, mesh, spin, about);
    const Vec3 expected = -mass * spin.cross(spin.cross(Vec3(-about)));
    CHECK((resultant(load) - expected).norm() < 1e-4 * expected.norm());
    // About the centre of mass: -r x (w x (w x r)) rho is - w x I w; the box's inertia.
    const Vec3 inertia = mass / 3.0 * Vec3(0.09 + 0.04, 0.25 + 0.04, 0.25 + 0.09);
    const Vec3 torque = -spin.cross(Vec3(inertia.cwiseProduct(spin)));
    CHECK((moment(mesh, centrifugal_load(*stiffness, mesh, spin, Vec3::Zero())) - torque).norm() <
          0.03 * torque.norm());
  }
  CHECK(mean_edge_length(whole) == Approx(0.1 * (2.0 + 4.0 * core::sqrt(0.75)) / 6.0).epsilon(0.05));
}
