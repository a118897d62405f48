// The kernels of a front: what they compute, and that wide registers give the bits of narrow ones.
#include "engine/stress/front_tiles.h"

#include <catch2/catch.hpp>
#include <vector>

#include "engine/core/random.h"

using namespace shatterbox;
using namespace shatterbox::stress;

namespace {

struct Panel {
  int pivots = 0, rows = 0;
  std::vector<double> panel, rest, least;
};

double& entry(Panel& p, int i, int j) {
  const int row =
      i < p.pivots ? i : i - p.pivots + tiles::kRows * static_cast<int>(tiles::strip_count(p.pivots));
  return p.panel[static_cast<std::size_t>((row / tiles::kRows) * tiles::kRows * p.pivots + tiles::kRows * j +
                                          row % tiles::kRows)];
}

Panel make_panel(int pivots, int rows) {
  Panel p{pivots, rows, {}, {}, {}};
  p.panel.assign(tiles::panel_size(pivots, rows), 0.0);
  p.rest.assign(tiles::rest_size(rows), 0.0);
  p.least.assign(static_cast<std::size_t>(pivots), 0.0);
  core::Random random(7, static_cast<std::uint64_t>(100 * pivots + rows));
  for (int i = 0; i < pivots + rows; ++i)
    for (int j = 0; j < std::min(i + 1, pivots); ++j) entry(p, i, j) = random.uniform(-1.0, 1.0);
  for (int j = 0; j < pivots; ++j) entry(p, j, j) = pivots + rows;
  for (double& value : p.rest) value = random.uniform(-1.0, 1.0);
  return p;
}

bool run(const tiles::Kernels& kernels, Panel& p) {
  if (!kernels.factor_panel(p.panel.data(), p.pivots, p.rows, p.least.data())) return false;
  const std::size_t strips = tiles::strip_count(p.rows);
  // In two parts, as two threads would.
  kernels.subtract_products(p.panel.data(), p.pivots, p.rows, p.rest.data(), 0, strips / 2);
  kernels.subtract_products(p.panel.data(), p.pivots, p.rows, p.rest.data(), strips / 2, strips);
  return true;
}

}  // namespace

TEST_CASE("a panel's factor times itself is the panel, and the rest is relieved of what it explains") {
  for (const int pivots : {1, 4, 7, 18})
    for (const int rows : {0, 3, 9}) {
      Panel p = make_panel(pivots, rows);
      Panel before = p;
      REQUIRE(run(tiles::narrow_kernels(), p));
      for (int j = 0; j < pivots; ++j) entry(p, j, j) = 1.0 / entry(p, j, j);
      const auto product = [&](int i, int j) {
        double sum = 0.0;
        for (int q = 0; q <= std::min(j, pivots - 1); ++q) sum += entry(p, i, q) * entry(p, j, q);
        return sum;
      };
      for (int j = 0; j < pivots; ++j)
        for (int i = j; i < pivots + rows; ++i)
          CHECK(product(i, j) == Approx(entry(before, i, j)).margin(1e-12));
      for (int j = 0; j < rows; ++j)
        for (int i = j; i < rows; ++i) {
          const auto at = tiles::rest_strip(static_cast<std::size_t>(i / tiles::kRows)) +
                          static_cast<std::size_t>(tiles::kRows * j + i % tiles::kRows);
          CHECK(before.rest[at] - p.rest[at] == Approx(product(pivots + i, pivots + j)).margin(1e-12));
        }
    }
}

TEST_CASE("a pivot that is not positive is refused") {
  Panel p = make_panel(6, 2);
  entry(p, 4, 4) = 0.0;
  CHECK_FALSE(run(tiles::narrow_kernels(), p));
  if (tiles::wide_kernels()) {
    Panel q = make_panel(6, 2);
    entry(q, 4, 4) = 0.0;
    CHECK_FALSE(run(*tiles::wide_kernels(), q));
  }
}

TEST_CASE("wide registers give the bits of narrow ones") {
  if (!tiles::wide_kernels()) return;
  for (const int pivots : {1, 2, 3, 4, 5, 8, 13, 30})
    for (const int rows : {0, 1, 4, 6, 8, 11, 16, 37}) {
      Panel narrow = make_panel(pivots, rows);
      Panel wide = narrow;
      REQUIRE(run(tiles::narrow_kernels(), narrow));
      REQUIRE(run(*tiles::wide_kernels(), wide));
      CHECK(narrow.panel == wide.panel);
      CHECK(narrow.rest == wide.rest);
      std::vector<double> x(static_cast<std::size_t>(4 * pivots)), y, sums(16), wide_sums(16);
      core::Random random(11, 0);
      for (double& value : x) value = random.uniform(-1.0, 1.0);
      y = x;
      tiles::narrow_kernels().multiply_lanes(narrow.panel.data(), x.data(), pivots, sums.data());
      tiles::wide_kernels()->multiply_lanes(narrow.panel.data(), x.data(), pivots, wide_sums.data());
      CHECK(sums == wide_sums);
      tiles::narrow_kernels().subtract_lanes(narrow.panel.data(), sums.data(), pivots, x.data());
      tiles::wide_kernels()->subtract_lanes(narrow.panel.data(), sums.data(), pivots, y.data());
      CHECK(x == y);
    }
}
