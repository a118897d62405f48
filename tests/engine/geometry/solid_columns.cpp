// Columns of a solid: as long as the material is, wherever the lines go, along edges and through holes too.
#include "engine/geometry/solid_columns.h"

#include <catch2/catch.hpp>

#include <cmath>

#include "engine/geometry/box_tets.h"
#include "engine/geometry/solid_punch.h"
#include "tests/engine/geometry/solids.h"

using namespace shatterbox;
using namespace shatterbox::geometry;

namespace {

SolidComplex make_block(const Vec3& half, double element_size) {
  auto elements = std::make_shared<SolidElements>();
  elements->mesh = make_box_tets(half, element_size).value();
  elements->topology = build_tet_topology(elements->mesh.tetrahedra);
  SolidComplex complex = make_solid_complex(elements);
  settle(complex);
  return complex;
}

}  // namespace

TEST_CASE("columns of a plate are as long as it is thick over the cosine and say that") {
  const SolidComplex plate = make_block(Vec3(0.2, 0.15, 0.01), 0.02);
  for (const double degrees : {0.0, 30.0, 50.0}) {
    const double turn = degrees * 3.14159265358979323846 / 180.0;
    const Vec3 along(std::sin(turn), 0.0, std::cos(turn));
    const ColumnAxes axes{Vec3::UnitY().cross(along), Vec3::UnitY(), along};
    std::vector<Vec2> places;
    // Multiples of the elements' size among them: lines in faces and along edges.
    for (int i = -4; i <= 4; ++i)
      for (int k = -6; k <= 6; ++k) places.emplace_back(0.01 * i, 0.02 * k + 0.003 * (i % 2));
    const std::vector<Column> columns = find_columns(plate, test::all_cells(plate), axes, places);
    REQUIRE(columns.size() == places.size());
    for (const Column& column : columns) {
      CHECK(column.length == Approx(0.02 / std::cos(turn)).epsilon(1e-12));
      CHECK(column.square_in == Approx(std::cos(turn)));
      CHECK(column.square_out == Approx(std::cos(turn)));
      CHECK(column.end - column.begin == Approx(column.length));
    }
    CHECK(find_columns(plate, test::all_cells(plate), axes, {Vec2(0.3, 0.0), Vec2(0.0, 0.151)})[0].length ==
          0.0);
    CHECK(find_columns(plate, test::all_cells(plate), axes, {Vec2(0.3, 0.0), Vec2(0.0, 0.151)})[1].length ==
          0.0);
  }
}

TEST_CASE("columns add up to the volume of what they go through and of what is left beside a punched part") {
  SolidComplex block = make_block(Vec3(0.05, 0.05, 0.05), 0.03);
  // A wedge: its column grows from nothing to the whole block.
  const std::vector<PunchSide> sides{{Vec3(1.0, 0.2, 1.0), 0.004}};
  std::vector<int> groups(block.cells.size(), -1);
  for (const int cell : find_punch_cells(block, sides, Vec3(-0.05, 0, -0.05)))
    groups[static_cast<std::size_t>(cell)] = 0;
  const Punched punched = punch_out(block, {{sides, 0}}, groups, 3);
  std::vector<int> inside, outside;
  for (std::size_t c = 0; c < punched.region_of.size(); ++c)
    (punched.region_of[c] == 0 ? inside : outside).push_back(static_cast<int>(c));
  std::vector<Vec2> places;
  constexpr int kSide = 200;
  for (int i = 0; i < kSide; ++i)
    for (int k = 0; k < kSide; ++k)
      places.emplace_back(0.1 * (i + 0.5) / kSide - 0.05, 0.1 * (k + 0.5) / kSide - 0.05);
  const double area = 0.01 / (kSide * kSide);
  const auto volume_of = [&](const std::vector<Column>& columns) {
    double volume = 0.0;
    for (const Column& column : columns) volume += area * column.length;
    return volume;
  };
  const auto within = find_columns(block, inside, {}, places),
             beside = find_columns(block, outside, {}, places);
  CHECK(volume_of(within) == Approx(punched.volumes[0]).epsilon(1e-3));
  CHECK(volume_of(beside) == Approx(1e-3 - punched.volumes[0]).epsilon(1e-3));
  for (std::size_t i = 0; i < places.size(); ++i)
    CHECK(within[i].length + beside[i].length == Approx(0.1).epsilon(1e-9));
}
