#include "engine/geometry/box_tets.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <set>
#include <tuple>

#include "engine/core/elementary.h"
#include "engine/geometry/mass_properties.h"
#include "engine/geometry/tet_quality.h"

using namespace shatterbox;
using namespace shatterbox::geometry;

namespace {

constexpr double kDegree = core::kPi / 180.0;

using Point = std::tuple<double, double, double>;

Point point(const Vec3& p) {
  return {p.x(), p.y(), p.z()};
}

/// The tetrahedra as sets of places, after a change of sign of one axis (or of none: -1).
std::set<std::set<Point>> places(const TetMesh& mesh, int mirrored_axis) {
  std::set<std::set<Point>> all;
  for (const Tetrahedron& t : mesh.tetrahedra) {
    std::set<Point> corners;
    for (const int v : t) {
      Vec3 p = mesh.positions[static_cast<std::size_t>(v)];
      if (mirrored_axis >= 0 && p[mirrored_axis] != 0.0) p[mirrored_axis] = -p[mirrored_axis];
      corners.insert(point(p));
    }
    all.insert(corners);
  }
  return all;
}

}  // namespace

TEST_CASE("box tets: a box is filled exactly, its border is flat to the bit") {
  for (const Vec3& half : {Vec3(0.5, 0.5, 0.5), Vec3(1.0, 0.3, 0.07), Vec3(0.1, 0.7, 0.3)})
    for (const double size : {5.0, 0.3, 0.11}) {
      const TetMesh mesh = make_box_tets(half, size).value();
      const TetQuality quality = measure_quality(mesh);
      const double volume = 8.0 * half.prod();
      CHECK(quality.volume == Approx(volume).epsilon(1e-12));
      CHECK(quality.least_volume > 0.0);
      const TriangleMesh surface = boundary_surface(mesh, build_tet_topology(mesh.tetrahedra));
      CHECK(enclosed_volume(surface) == Approx(volume).epsilon(1e-12));
      CHECK(surface_area(surface) ==
            Approx(8.0 * (half.x() * half.y() + half.y() * half.z() + half.z() * half.x())).epsilon(1e-12));
      for (const Triangle& t : surface.triangles) {
        bool is_on_a_face = false;
        for (int axis = 0; axis < 3; ++axis)
          for (const double side : {-half[axis], half[axis]})
            is_on_a_face |= std::all_of(t.begin(), t.end(), [&](int v) {
              return surface.positions[static_cast<std::size_t>(v)][axis] == side;
            });
        CHECK(is_on_a_face);
      }
    }
}

TEST_CASE("box tets: cubes have angles from 45 to 90 degrees, and 12 tetrahedra a cell inside") {
  const TetQuality quality = measure_quality(make_box_tets(Vec3::Constant(0.5), 0.1).value());
  CHECK(quality.count == 12 * 1000 + 6 * 100 * 2);
  CHECK(quality.least_dihedral == Approx(45.0 * kDegree));
  CHECK(quality.greatest_dihedral == Approx(90.0 * kDegree));
  CHECK(quality.median_least_dihedral == Approx(60.0 * kDegree));
  CHECK(quality.worst_aspect == Approx(core::sqrt(8.0)));  // at the border, where they are halves
  CHECK(quality.median_aspect == Approx(core::sqrt(2.0)));
}

TEST_CASE("box tets: the mesh is its own mirror image, and every vertex inside has 14 edges") {
  const TetMesh mesh = make_box_tets(Vec3(0.3, 0.2, 0.4), 0.1).value();
  const auto original = places(mesh, -1);
  for (int axis = 0; axis < 3; ++axis) CHECK(places(mesh, axis) == original);
  std::map<int, int> edge_counts;
  for (const auto& edge : build_tet_topology(mesh.tetrahedra).edges)
    for (const int v : edge) ++edge_counts[v];
  for (const auto& [v, count] : edge_counts) {
    const Vec3 left = Vec3(0.3, 0.2, 0.4) - mesh.positions[static_cast<std::size_t>(v)].cwiseAbs();
    if (left.minCoeff() > 0.09) CHECK(count == 14);
  }
}

TEST_CASE("box tets: elements stay well-shaped in thin plates and long bars") {
  for (const Vec3& half : {Vec3(1.0, 1.0, 0.01), Vec3(0.02, 0.02, 1.0), Vec3(0.5, 0.013, 0.07)}) {
    const TetQuality quality = measure_quality(make_box_tets(half, 0.1).value());
    CHECK(quality.least_dihedral > 25.0 * kDegree);
    CHECK(quality.worst_aspect < 6.0);
  }
}

TEST_CASE("box tets: nonsense is refused with a sentence") {
  CHECK_FALSE(make_box_tets(Vec3(1.0, 0.0, 1.0), 0.1));
  CHECK_FALSE(make_box_tets(Vec3::Ones(), -1.0));
  CHECK(make_box_tets(Vec3::Ones(), 1e-4).error().find("make it larger") != std::string::npos);
}

TEST_CASE("tet quality: a regular tetrahedron, a flat one") {
  const TetShape regular =
      tetrahedron_shape({Vec3(1, 1, 1), Vec3(1, -1, -1), Vec3(-1, -1, 1), Vec3(-1, 1, -1)});
  for (const double angle : regular.dihedrals) CHECK(angle == Approx(core::acos(1.0 / 3.0)));
  CHECK(regular.aspect == Approx(core::sqrt(1.5)));
  const TetShape corner = tetrahedron_shape({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)});
  CHECK(corner.dihedrals[0] == Approx(90.0 * kDegree));  // at the edge from corner 0 to corner 1
  CHECK(corner.dihedrals[5] == Approx(core::acos(1.0 / core::sqrt(3.0))));
  const TetShape flat = tetrahedron_shape({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(1, 1, 0)});
  CHECK(flat.aspect > 1e300);
  CHECK(measure_quality({}).count == 0);
}
