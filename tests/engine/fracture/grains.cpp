// Grain boundaries cross an edge at the same place from both of its triangles, and never at a vertex.
#include "engine/fracture/grains.h"

#include <catch2/catch.hpp>
#include <map>

#include "tests/engine/fracture/shapes.h"

using namespace shatterbox;

TEST_CASE("the lower envelope agrees across the edges of the elements") {
  const auto elements = test::make_sphere(0.04, 0.003);
  const auto seeds = fracture::scatter_grain_seeds(*elements, 0.008, 11);
  CHECK(seeds.size() > 150);
  CHECK(seeds.size() < 450);
  const auto field = fracture::make_grain_field(*elements, seeds);
  std::map<int, std::vector<std::vector<double>>> by_edge;
  for (std::size_t t = 0; t < elements->mesh.triangles.size(); ++t) {
    std::map<int, std::vector<double>> own;
    for (const int edge : elements->topology.triangle_edges[t]) own[edge];
    for (const auto& crossing : fracture::find_grain_crossings(field, *elements, static_cast<int>(t)))
      own[crossing.edge].push_back(crossing.parameter);
    for (auto& [edge, parameters] : own) by_edge[edge].push_back(parameters);
  }
  int crossings = 0;
  for (const auto& [edge, sides] : by_edge) {
    REQUIRE(sides.size() == 2);
    CHECK(sides[0] == sides[1]);
    crossings += static_cast<int>(sides[0].size());
    for (const double q : sides[0]) {
      CHECK(q > 0.01);
      CHECK(q < 0.99);
    }
  }
  CHECK(crossings > 500);
}

TEST_CASE("each grain owns the places about its seed") {
  const auto elements = test::make_pane(0.2, 0.005);
  const auto field = fracture::make_grain_field(*elements, fracture::scatter_grain_seeds(*elements, 0.03, 2));
  for (std::size_t t = 0; t < elements->mesh.triangles.size(); ++t) {
    const Vec2 middle(1.0 / 3.0, 1.0 / 3.0);
    const Vec3 x = position_in_element(*elements, static_cast<int>(t), middle);
    const int grain = fracture::grain_at(field, static_cast<int>(t), middle);
    REQUIRE(grain >= 0);
    double least = 1e300;
    for (const auto& seed : field.seeds) least = std::min(least, seed.weight * (seed.position - x).norm());
    const auto& own = field.seeds[static_cast<std::size_t>(grain)];
    CHECK(own.weight * (own.position - x).norm() < least + 0.004);
  }
}

TEST_CASE("grains of a sheet are long along the material's direction") {
  const auto elements = test::make_pane(0.2, 0.003);
  for (const int axis : {0, 1}) {
    material::Material m;
    m.grain_direction = 3.0 * Vec3::Unit(axis);
    const Mat3 squeeze = fracture::grain_squeeze(m);
    const auto field = fracture::make_grain_field(
        *elements, fracture::scatter_grain_seeds(*elements, 0.015, 2, squeeze), squeeze);
    std::vector<std::vector<Vec3>> members(field.seeds.size());
    for (int t = 0; t < static_cast<int>(elements->mesh.triangles.size()); ++t) {
      const Vec2 middle(1.0 / 3.0, 1.0 / 3.0);
      members[static_cast<std::size_t>(fracture::grain_at(field, t, middle))].push_back(
          position_in_element(*elements, t, middle));
    }
    double along = 0.0, across = 0.0;
    for (const auto& list : members) {
      Vec3 mean = Vec3::Zero();
      for (const Vec3& x : list) mean += x / static_cast<double>(list.size());
      for (const Vec3& x : list) {
        along += (x - mean)[axis] * (x - mean)[axis];
        across += (x - mean)[1 - axis] * (x - mean)[1 - axis];
      }
    }
    REQUIRE(across > 0.0);
    CHECK(std::sqrt(along / across) == Approx(3.0).epsilon(0.25));
  }
}

TEST_CASE("without seeds there are no grains") {
  const auto elements = test::make_pane(0.2, 0.05);
  const auto field = fracture::make_grain_field(*elements, {});
  CHECK(field.is_empty());
  CHECK(fracture::grain_at(field, 0, Vec2(0.2, 0.2)) == -1);
  CHECK(fracture::find_grain_crossings(field, *elements, 0).empty());
}
