#include "engine/geometry/material_cells.h"

#include <array>
#include <catch2/catch.hpp>

#include "engine/geometry/generators.h"

using namespace shatterbox;
using namespace shatterbox::geometry;

namespace {

/// The polygons of a surface of triangles. `triangles` must outlive them.
std::vector<ElementPolygon> polygons_of(const std::vector<Triangle>& triangles) {
  std::vector<ElementPolygon> polygons;
  for (const Triangle& t : triangles) polygons.push_back({t.data(), 3, false, -1});
  return polygons;
}

/// Adds a hollow with one corner at an existing vertex and three nearer to the origin.
void add_hollow(TriangleMesh& mesh, int apex, double size) {
  const int first = static_cast<int>(mesh.positions.size());
  const Vec3 a = mesh.positions[static_cast<std::size_t>(apex)];
  for (int axis = 0; axis < 3; ++axis)
    mesh.positions.push_back(a - size * (a / a.cwiseAbs().maxCoeff()) + 0.4 * size * Vec3::Unit(axis));
  std::vector<Triangle> faces{{apex, first, first + 1},
                              {apex, first + 1, first + 2},
                              {apex, first + 2, first},
                              {first, first + 2, first + 1}};
  for (Triangle& t : faces) {
    std::swap(t[1], t[2]);
    mesh.triangles.push_back(t);
  }
}

}  // namespace

TEST_CASE("material cells: a hollow that touches the border in a corner belongs to what is about it") {
  // The hollow's first corner is the box': from there the box is seen under less than half of all directions.
  TriangleMesh mesh = make_box_surface(Vec3::Ones());
  add_hollow(mesh, 7, 0.5);
  std::vector<ElementPolygon> polygons = polygons_of(mesh.triangles);
  const std::vector<MaterialPart> parts = divide_into_parts(mesh.positions, polygons, 1e-14);
  REQUIRE(parts.size() == 1);
  double hollow = 0.0;
  for (std::size_t t = 12; t < 16; ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const auto p = [&](int v) { return mesh.positions[static_cast<std::size_t>(v)]; };
    hollow += p(a).dot(p(b).cross(p(c))) / 6.0;
  }
  CHECK(hollow < -1e-3);
  CHECK(parts[0].volume == Approx(8.0 + hollow));
}

TEST_CASE("material cells: two bodies are two parts, and a hollow goes to the smaller one about it") {
  TriangleMesh mesh = make_box_surface(Vec3::Ones());
  const auto add = [&](double size, const Vec3& middle, bool is_hollow) {
    TriangleMesh box = make_box_surface(Vec3::Constant(size));
    const int first = static_cast<int>(mesh.positions.size());
    for (const Vec3& p : box.positions) mesh.positions.push_back(p + middle);
    for (Triangle t : box.triangles) {
      if (is_hollow) std::swap(t[1], t[2]);
      mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    }
  };
  add(0.5, Vec3::Zero(), true);
  add(0.3, Vec3::Zero(), false);
  add(0.1, Vec3::Zero(), true);
  add(0.2, Vec3(4, 0, 0), false);
  std::vector<ElementPolygon> polygons = polygons_of(mesh.triangles);
  const std::vector<MaterialPart> parts = divide_into_parts(mesh.positions, polygons, 1e-14);
  REQUIRE(parts.size() == 3);
  CHECK(parts[0].volume == Approx(8.0 - 1.0));
  CHECK(parts[1].volume == Approx(0.216 - 0.008));
  CHECK(parts[2].volume == Approx(0.064));
  CHECK((parts[2].centroid - Vec3(4, 0, 0)).norm() < 1e-12);
  for (std::size_t i = 0; i < polygons.size(); ++i) {
    const int expected = i < 24 ? 0 : i < 48 ? 1 : 2;
    CHECK(polygons[i].part == expected);
  }
}
