// The kerf of a solid's pieces: they stand apart, cross nothing, and keep the outer surface.
#include "engine/geometry/solid_kerf.h"

#include <catch2/catch.hpp>

#include "engine/fracture/split_solid.h"
#include "engine/geometry/crossings.h"
#include "engine/geometry/generators.h"
#include "engine/geometry/tetrahedralise.h"
#include "tests/engine/geometry/solids.h"
#include "tests/support/sanitized.h"

using namespace shatterbox;
using namespace shatterbox::geometry;

namespace {

/// True if an edge of a surface passes through one of its triangles.
bool crosses_itself(const TriangleMesh& mesh) {
  const auto p = [&](int v) -> const Vec3& { return mesh.positions[static_cast<std::size_t>(v)]; };
  for (const Triangle& s : mesh.triangles)
    for (const Triangle& t : mesh.triangles)
      for (std::size_t i = 0; i < 3; ++i)
        if (segment_pierces_triangle(p(s[i]), p(s[(i + 1) % 3]), p(t[0]), p(t[1]), p(t[2]))) return true;
  return false;
}

std::vector<TriangleMesh> pieces_with_kerf(SolidComplex complex, double kerf, double& least) {
  std::vector<TriangleMesh> meshes;
  least = kerf;
  for (const auto& piece : fracture::split_solid(std::move(complex)).pieces) {
    SolidSurface surface = extract_surface(piece.complex);
    least = std::min(least, stand_back(surface, kerf));
    meshes.push_back(std::move(surface.mesh));
  }
  return meshes;
}

}  // namespace

TEST_CASE("solid kerf: halves stand apart by two kerfs, their outer faces stay in their planes") {
  const double kerf = 1e-3;
  SolidComplex complex = make_solid_complex(test::make_cube_elements(3, 0.2));
  SolidCutter(complex, 1e-9).cut(test::plane_cut(complex, Vec3::UnitX(), 0.41));
  double least = 0.0;
  const auto halves = pieces_with_kerf(complex, kerf, least);
  REQUIRE(halves.size() == 2);
  CHECK(least == Approx(kerf));
  CHECK(enclosed_volume(halves[0]) == Approx(0.59 - kerf));
  CHECK(enclosed_volume(halves[1]) == Approx(0.41 - kerf));
  for (const TriangleMesh& half : halves) {
    Vec3 low = half.positions[0], high = low;
    for (const Vec3& p : half.positions) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    CHECK((low.tail<2>()).norm() < 1e-15);
    CHECK((high.tail<2>() - Vec2::Ones()).norm() < 1e-15);
    CHECK(high.x() - low.x() == Approx((&half == &halves[0] ? 0.59 : 0.41) - kerf));
  }
}

TEST_CASE("solid kerf: corners between three cracks retreat from all of them") {
  const double kerf = 2e-3;
  SolidComplex complex = make_solid_complex(test::make_cube_elements(4));
  SolidCutter cutter(complex);
  for (int k = 0; k < 3; ++k) cutter.cut(test::plane_cut(complex, Vec3::Unit(k), 0.4, k));
  double least = 0.0;
  const auto pieces = pieces_with_kerf(complex, kerf, least);
  REQUIRE(pieces.size() == 8);
  CHECK(least == Approx(kerf));
  double sum = 0.0;
  for (const TriangleMesh& piece : pieces) sum += enclosed_volume(piece);
  CHECK(sum == Approx(std::pow(1.0 - 2.0 * kerf, 3)));
}

TEST_CASE("solid kerf: a wide kerf gives way where the material is narrow") {
  SolidComplex complex = make_solid_complex(test::make_cube_elements(2));
  SolidCutter cutter(complex);
  cutter.cut(test::plane_cut(complex, Vec3::UnitX(), 0.55, 0));
  cutter.cut(test::plane_cut(complex, Vec3::UnitX(), 0.60, 1));
  double least = 0.0;
  const auto pieces = pieces_with_kerf(complex, 0.1, least);
  REQUIRE(pieces.size() == 3);
  CHECK(least > 0.003);
  CHECK(least <= 0.05 / 4.0);
  for (const TriangleMesh& piece : pieces) CHECK(enclosed_volume(piece) > 0.0);
  CHECK(enclosed_volume(pieces[2]) >= 0.05 * 0.4);
}

TEST_CASE("solid kerf: pieces of random cuts cross neither each other nor themselves") {
  int crossing = 0, self_crossing = 0, empty = 0;
  for (int trial = 0; trial < test::how_many(90, 30); ++trial) {
    core::Random random(21, static_cast<std::uint64_t>(trial));
    SolidComplex complex =
        make_solid_complex(test::make_cube_elements(1 + trial % 2, 0.2, static_cast<std::uint64_t>(trial)));
    SolidCutter cutter(complex);
    SolidCut last = test::plane_cut(complex, Vec3::UnitX(), 0.4);
    const int count = 1 + static_cast<int>(random.index(6));
    for (int i = 0; i < count; ++i) {
      SolidCut cut = test::random_cut(complex, random, i, &last);
      if (trial % 3 != 0) keep_off_nodes(complex, 0.05, cut);
      cutter.cut(cut);
    }
    double least = 0.0;
    const auto pieces = pieces_with_kerf(complex, trial % 2 == 0 ? 0.003 : 0.05, least);
    crossing += count_crossing_pairs(pieces) > 0;
    for (const TriangleMesh& piece : pieces) {
      self_crossing += crosses_itself(piece);
      empty += !(enclosed_volume(piece) > 0.0);
    }
  }
  CHECK(crossing == 0);
  CHECK(self_crossing == 0);
  CHECK(empty == 0);
}

TEST_CASE("solid kerf: an embedded ball keeps its given triangles, and its pieces cross nothing") {
  const TriangleMesh given = make_sphere(0.5, {0.15, 0.3, 1}).value();
  TetrahedraOptions options;
  options.element_size = 0.25;
  const EmbeddedSolid solid = tetrahedralise(given, options).value();
  const SolidComplex whole = build_solid_complex(solid.elements, solid.embedded.material);
  REQUIRE(are_cells_closed(whole));
  const double volume = enclosed_volume(given);
  CHECK(total_volume(whole) == Approx(volume).epsilon(1e-12));
  const SolidSurface surface = extract_surface(whole);
  CHECK(surface.mesh.triangles.size() < given.triangles.size() + 10);
  std::vector<double> areas(given.triangles.size(), 0.0);
  const auto area = [](const TriangleMesh& mesh, const Triangle& t) {
    const auto p = [&](std::size_t k) { return mesh.positions[static_cast<std::size_t>(t[k])]; };
    return 0.5 * (p(1) - p(0)).cross(p(2) - p(0)).norm();
  };
  for (std::size_t t = 0; t < surface.mesh.triangles.size(); ++t)
    areas[static_cast<std::size_t>(surface.triangle_sources[t])] +=
        area(surface.mesh, surface.mesh.triangles[t]);
  for (std::size_t t = 0; t < areas.size(); ++t)
    CHECK(areas[t] == Approx(area(given, given.triangles[t])).epsilon(1e-9));

  for (long seed = 0; seed < test::how_many(4, 2); ++seed) {
    core::Random random(7, static_cast<std::uint64_t>(seed));
    SolidComplex complex = whole;
    SolidCutter cutter(complex);
    for (int i = 0; i < 4; ++i) {
      const Vec3 normal = Vec3(random.normal(), random.normal(), random.normal()).normalized();
      SolidCut cut = test::plane_cut(complex, normal, 0.25 * random.normal(), i);
      keep_off_nodes(complex, 0.05, cut);
      cutter.cut(cut);
    }
    double sum = 0.0;
    for (const auto& piece : fracture::split_solid(complex).pieces)
      sum += solid_mass_properties(piece.complex, 1.0).mass;
    CHECK(sum == Approx(volume).epsilon(1e-12));
    double least = 0.0;
    const auto pieces = pieces_with_kerf(complex, 0.002, least);
    CHECK(pieces.size() > 4);
    CHECK(count_crossing_pairs(pieces) == 0);
    for (const TriangleMesh& piece : pieces) CHECK_FALSE(crosses_itself(piece));
  }
}
