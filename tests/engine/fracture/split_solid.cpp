// Splitting a cut solid loses nothing, and merges what nothing could resolve.
#include "engine/fracture/split_solid.h"

#include <catch2/catch.hpp>

#include "tests/engine/geometry/solids.h"

using namespace shatterbox;
using namespace shatterbox::geometry;
using fracture::split_solid;

TEST_CASE("split solid: a cube in eight") {
  SolidComplex complex = make_solid_complex(test::make_cube_elements(3, 0.2));
  SolidCutter cutter(complex);
  for (int k = 0; k < 3; ++k) {
    SolidCut cut = test::plane_cut(complex, Vec3::Unit(k), 0.6, k);
    keep_off_nodes(complex, 0.05, cut);
    cutter.cut(cut);
  }
  const auto split = split_solid(complex);
  REQUIRE(split.pieces.size() == 8);
  double sum = 0.0, last = 1.0;
  for (const auto& piece : split.pieces) {
    CHECK(are_cells_closed(piece.complex));
    CHECK(piece.mesh.cells.size() == piece.complex.cells.size());
    CHECK(total_volume(piece.complex) <= last);
    last = total_volume(piece.complex);
    sum += last;
  }
  CHECK(sum == Approx(1.0).epsilon(1e-13));
  CHECK(total_volume(split.pieces[0].complex) == Approx(0.216).epsilon(0.05));
  CHECK(total_volume(split.pieces[7].complex) == Approx(0.064).epsilon(0.1));
}

TEST_CASE("split solid: a plate too thin joins what it has most in common with") {
  SolidComplex complex = make_solid_complex(test::make_cube_elements(3));
  SolidCutter cutter(complex, 1e-3);
  cutter.cut(test::plane_cut(complex, Vec3::UnitX(), 0.50, 0));
  cutter.cut(test::plane_cut(complex, Vec3::UnitX(), 0.52, 1));
  CHECK(split_solid(complex, 0.019).pieces.size() == 3);
  const auto split = split_solid(complex, 0.021);
  CHECK(split.pieces.size() == 2);
  CHECK(split.merged_count == 1);
  CHECK(split.merged_volume == Approx(0.02));
}

TEST_CASE("split solid: a boundary that holds keeps one piece, whose cells share their nodes") {
  SolidComplex complex = make_solid_complex(test::make_cube_elements(2));
  SolidCutter cutter(complex);
  SolidCut cut = test::plane_cut(complex, Vec3(1, 2, 3), 2.7);
  cut.kind = FacetKind::grain;
  cutter.cut(cut);
  const auto split = split_solid(complex);
  REQUIRE(split.pieces.size() == 1);
  CHECK(split.pieces[0].mesh.cells.size() > 48);
  CHECK(split.pieces[0].mesh.vertex_source.size() == 27);
}

TEST_CASE("split solid: random cuts") {
  core::Random random(11);
  for (int trial = 0; trial < 1500; ++trial) {
    const int n = 1 + trial % 2;
    SolidComplex complex =
        make_solid_complex(test::make_cube_elements(n, 0.3, static_cast<std::uint64_t>(trial)));
    SolidCutter cutter(complex, trial % 3 == 0 ? SolidCutter::kLeastSnap : SolidCutter::kUsualSnap);
    SolidCut last = test::plane_cut(complex, Vec3::UnitX(), 0.4);
    const int count = 1 + static_cast<int>(random.index(n == 1 ? 12 : 6));
    for (int i = 0; i < count; ++i) {
      SolidCut cut = test::random_cut(complex, random, i, &last);
      if (random.index(3) == 0) keep_off_nodes(complex, 0.05, cut);
      cutter.cut(cut);
    }
    const auto split = split_solid(complex, trial % 5 == 0 ? 0.05 : 0.0);
    double sum = 0.0;
    bool is_closed = true;
    for (const auto& piece : split.pieces) {
      is_closed = is_closed && are_cells_closed(piece.complex);
      sum += total_volume(piece.complex);
    }
    INFO("trial " << trial);
    CHECK(is_closed);
    CHECK(std::abs(sum - 1.0) < 1e-12);
  }
}
