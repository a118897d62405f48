// The kerf of a solid's pieces: they stand apart, cross nothing, and keep the outer surface.
#include "engine/geometry/solid_kerf.h"

#include <cmath>

#include <catch2/catch.hpp>

#include "engine/fracture/split_solid.h"
#include "engine/geometry/closest_points.h"
#include "engine/geometry/crossings.h"
#include "engine/geometry/generators.h"
#include "engine/geometry/solid_punch.h"
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

std::vector<TriangleMesh> pieces_with_kerf(SolidComplex complex, double kerf, double& least,
                                           const SurfaceDistance* whole = nullptr) {
  std::vector<TriangleMesh> meshes;
  least = kerf;
  for (const auto& piece : fracture::split_solid(std::move(complex)).pieces) {
    SolidSurface surface = extract_surface(piece.complex);
    least = std::min(least, stand_back(surface, kerf, whole));
    meshes.push_back(std::move(surface.mesh));
  }
  return meshes;
}

/// How far outside of a closed surface a point is, m; 0 inside: by the surface's solid angle.
double distance_outside(const TriangleMesh& mesh, const Vec3& point) {
  double angle = 0.0, least = 1e300;
  for (const Triangle& t : mesh.triangles) {
    std::array<Vec3, 3> corner;
    for (std::size_t k = 0; k < 3; ++k) corner[k] = mesh.positions[static_cast<std::size_t>(t[k])];
    const Vec3 at = closest_on_triangle(point, corner[0], corner[1], corner[2]).barycentric;
    least = std::min(least, (at[0] * corner[0] + at[1] * corner[1] + at[2] * corner[2] - point).norm());
    const Vec3 a = corner[0] - point, b = corner[1] - point, c = corner[2] - point;
    angle += 2.0 * std::atan2(a.dot(b.cross(c)), a.norm() * b.norm() * c.norm() + a.dot(b) * c.norm() +
                                                     b.dot(c) * a.norm() + c.dot(a) * b.norm());
  }
  return angle > 6.283 ? 0.0 : least;
}

SolidCut whole_plane(const SolidComplex& complex, core::Random& random, int id) {
  Vec3 normal(random.normal(), 0.0, 0.0);
  normal.y() = random.normal();
  normal.z() = random.normal();
  normal.normalize();
  const double offset = normal.dot(Vec3::Constant(0.5)) + 0.2 * random.normal();
  return test::plane_cut(complex, normal, offset, id);
}

/// Four bars along z in a cube, of which two that touch along an edge hold together at the end: two half
/// cracks in one plane from both sides, each beside what a third crack parts. The material of one piece is
/// behind the plane on one side of it and in front on the other.
SolidComplex make_crossed_bars() {
  SolidComplex complex = make_solid_complex(test::make_cube_elements(4));
  SolidCutter cutter(complex);
  const auto cut_where = [&](const Vec3& normal, double offset, int id, auto&& is_in) {
    SolidCut cut = test::plane_cut(complex, normal, offset, id);
    std::erase_if(cut.cells, [&](int cell) {
      Vec3 middle = Vec3::Zero();
      const auto& t =
          complex.elements->mesh
              .tetrahedra[static_cast<std::size_t>(complex.cells[static_cast<std::size_t>(cell)].element)];
      for (const int v : t) middle += 0.25 * complex.elements->mesh.positions[static_cast<std::size_t>(v)];
      return !is_in(middle);
    });
    cutter.cut(cut);
  };
  const auto in_front = [](const Vec3& p) { return p.z() < 0.75; };
  cut_where(Vec3::UnitX(), 0.5, 0, in_front);
  cut_where(Vec3::UnitY(), 0.5, 1, in_front);
  cut_where(Vec3::UnitZ(), 0.75, 2, [](const Vec3& p) { return (p.x() < 0.5) != (p.y() < 0.5); });
  return complex;
}

/// How far vertices and middles of triangles are outside of a closed surface at most, m.
double farthest_outside(const TriangleMesh& whole, const TriangleMesh& part) {
  double farthest = 0.0;
  for (const auto& t : part.triangles) {
    Vec3 middle = Vec3::Zero();
    for (const int v : t) {
      const Vec3& p = part.positions[static_cast<std::size_t>(v)];
      middle += p / 3.0;
      farthest = std::max(farthest, distance_outside(whole, p));
    }
    farthest = std::max(farthest, distance_outside(whole, middle));
  }
  return farthest;
}

}  // namespace

TEST_CASE(
    "solid kerf: a vertex where material goes on from one side of a crack to the other becomes several") {
  const double kerf = 1e-3;
  const SolidComplex complex = make_crossed_bars();
  double least = 0.0;
  const auto pieces = pieces_with_kerf(complex, kerf, least);
  REQUIRE(pieces.size() == 3);
  CHECK(least > 0.1 * kerf);
  CHECK(count_crossing_pairs(pieces) == 0);
  for (const TriangleMesh& piece : pieces) CHECK_FALSE(crosses_itself(piece));
}

TEST_CASE("solid kerf: pieces of pieces stick out of what they are of nowhere") {
  const double kerf = 2e-4;
  int crossing = 0, kept = 0;
  double farthest = 0.0;
  for (int trial = 0; trial < test::how_many(12, 4); ++trial) {
    core::Random random(33, static_cast<std::uint64_t>(trial));
    SolidComplex whole =
        make_solid_complex(test::make_cube_elements(2, 0.2, static_cast<std::uint64_t>(trial)));
    {
      SolidCutter cutter(whole);
      for (int i = 0; i < 3; ++i) cutter.cut(whole_plane(whole, random, i));
    }
    for (auto& piece : fracture::split_solid(std::move(whole)).pieces) {
      SolidSurface surface = extract_surface(piece.complex);
      stand_back(surface, kerf);
      keep_kerf(piece.complex, surface);
      CHECK(are_cells_closed(piece.complex));
      const SolidSurface again = extract_surface(piece.complex);
      kept += enclosed_volume(again.mesh) == Approx(enclosed_volume(surface.mesh)).epsilon(1e-9);
      SolidComplex complex = piece.complex;
      SolidCutter cutter(complex);
      for (int i = 0; i < 2; ++i) cutter.cut(whole_plane(complex, random, 3 + i));
      double least = 0.0;
      const auto pieces = pieces_with_kerf(std::move(complex), kerf, least);
      crossing += count_crossing_pairs(pieces) > 0;
      for (const TriangleMesh& part : pieces)
        farthest = std::max(farthest, farthest_outside(surface.mesh, part));
    }
  }
  CHECK(crossing == 0);
  CHECK(kept > 0);
  CHECK(farthest < 1e-5 * kerf);
}

TEST_CASE("solid kerf: what is cut where a vertex of the whole had become several stays within the whole") {
  const double kerf = 1e-3;
  double farthest = 0.0, farthest_alone = 0.0;
  for (auto& piece : fracture::split_solid(make_crossed_bars()).pieces) {
    SolidSurface surface = extract_surface(piece.complex);
    stand_back(surface, kerf);
    keep_kerf(piece.complex, surface);
    const SurfaceDistance whole(surface.mesh);
    for (int trial = 0; trial < test::how_many(8, 3); ++trial) {
      core::Random random(34, static_cast<std::uint64_t>(trial));
      SolidComplex complex = piece.complex;
      SolidCutter cutter(complex);
      for (int i = 0; i < 2; ++i) cutter.cut(whole_plane(complex, random, 3 + i));
      double least = 0.0;
      const auto alone = pieces_with_kerf(complex, kerf, least);
      const auto pieces = pieces_with_kerf(complex, kerf, least, &whole);
      CHECK(count_crossing_pairs(pieces) == 0);
      for (const TriangleMesh& part : alone)
        farthest_alone = std::max(farthest_alone, farthest_outside(surface.mesh, part));
      for (const TriangleMesh& part : pieces)
        farthest = std::max(farthest, farthest_outside(surface.mesh, part));
    }
  }
  CHECK(farthest_alone > 0.3 * kerf);
  CHECK(farthest < 1e-5 * kerf);
}

TEST_CASE("solid kerf: plane walls have few triangles, and what is cut from behind them hardly sticks out") {
  const double kerf = 2e-4;
  double farthest = 0.0;
  int crossing = 0;
  std::size_t triangles = 0, triangles_by_element = 0;
  for (int trial = 0; trial < test::how_many(6, 2); ++trial) {
    core::Random random(35, static_cast<std::uint64_t>(trial));
    const SolidComplex cube =
        make_solid_complex(test::make_cube_elements(4, 0.2, static_cast<std::uint64_t>(trial)));
    std::vector<Vec3> seeds(5);
    for (Vec3& seed : seeds)
      for (int axis = 0; axis < 3; ++axis) seed(axis) = random.uniform(0.1, 0.9);
    std::vector<PunchRegion> regions;  // of all but the first
    for (std::size_t r = 1; r < seeds.size(); ++r) {
      regions.emplace_back();
      for (const Vec3& other : seeds)
        if (&other != &seeds[r])
          regions.back().sides.push_back(
              {other - seeds[r], 0.5 * (other.squaredNorm() - seeds[r].squaredNorm())});
    }
    const std::vector<int> all(cube.cells.size(), 0);
    SolidComplex by_element = cube, complex = cube;
    punch_out(by_element, regions, all, 0);
    for (const auto& piece : fracture::split_solid(by_element, 1e-3).pieces)
      triangles_by_element += extract_surface(piece.complex).mesh.triangles.size();
    const Punched punched = punch_out(complex, regions, all, 0, Walls::plane);
    CHECK(punched.wall_area > 0.5);
    std::vector<TriangleMesh> cells;
    for (auto& piece : fracture::split_solid(complex, 1e-3).pieces) {
      SolidSurface surface = extract_surface(piece.complex);
      CHECK(enclosed_volume(surface.mesh) == Approx(total_volume(piece.complex)).epsilon(1e-5));
      triangles += surface.mesh.triangles.size();
      stand_back(surface, kerf);
      keep_kerf(piece.complex, surface);
      cells.push_back(surface.mesh);
      const SurfaceDistance whole(surface.mesh);
      SolidCutter cutter(piece.complex);
      for (int i = 0; i < 2; ++i) cutter.cut(whole_plane(piece.complex, random, 3 + i));
      double least = 0.0;
      const auto parts = pieces_with_kerf(piece.complex, kerf, least, &whole);
      crossing += count_crossing_pairs(parts) > 0;
      for (const TriangleMesh& part : parts)
        farthest = std::max(farthest, farthest_outside(surface.mesh, part));
    }
    crossing += count_crossing_pairs(cells) > 0;
  }
  CHECK(crossing == 0);
  CHECK(farthest < 0.15 * kerf);  // where a narrow place has kept a wall from going back as a plane
  CHECK(2 * triangles < triangles_by_element);
}

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
