#include "engine/stress/front_tiles.h"

#include <algorithm>

#include "engine/core/elementary.h"

namespace shatterbox::stress::tiles {

bool factor_diagonal(double* tile, int size, const double* least_pivots) {
  for (int j = 0; j < size; ++j) {
    double pivot = tile[kRows * j + j];
    for (int q = 0; q < j; ++q) pivot -= tile[kRows * q + j] * tile[kRows * q + j];
    if (!(pivot > least_pivots[j])) return false;
    const double inverse = 1.0 / core::sqrt(pivot);
    tile[kRows * j + j] = inverse;
    for (int i = 0; i < j; ++i) tile[kRows * j + i] = 0.0;
    for (int i = j + 1; i < kRows; ++i) {
      double entry = tile[kRows * j + i];
      for (int q = 0; q < j; ++q) entry -= tile[kRows * q + i] * tile[kRows * q + j];
      tile[kRows * j + i] = entry * inverse;
    }
  }
  return true;
}

namespace {

/// c <- c L^-T for `columns` columns of a strip, L a factored diagonal tile.
void solve_strip(double* c, const double* diagonal, int columns) {
  Pair low[4];
  Pair high[4];
  for (int j = 0; j < columns; ++j) {
    low[j] = *reinterpret_cast<Pair*>(c + kRows * j);
    high[j] = *reinterpret_cast<Pair*>(c + kRows * j + 2);
    for (int q = 0; q < j; ++q) {
      const Pair factor = {diagonal[kRows * q + j], diagonal[kRows * q + j]};
      low[j] -= low[q] * factor;
      high[j] -= high[q] * factor;
    }
    const Pair inverse = {diagonal[kRows * j + j], diagonal[kRows * j + j]};
    low[j] *= inverse;
    high[j] *= inverse;
    *reinterpret_cast<Pair*>(c + kRows * j) = low[j];
    *reinterpret_cast<Pair*>(c + kRows * j + 2) = high[j];
  }
}

bool factor_panel(double* panel, int pivots, int rows, const double* least_pivots) {
  const Size strip_size = static_cast<Size>(kRows) * static_cast<Size>(pivots);
  const Size pivot_strips = strip_count(pivots);
  const Size strips = pivot_strips + strip_count(rows);
  for (Size block = 0; block < pivot_strips; ++block) {
    const int first = kRows * static_cast<int>(block);
    const int columns = std::min(kRows, pivots - first);
    double* const diagonal_strip = panel + block * strip_size;
    double* const diagonal = diagonal_strip + static_cast<Size>(kRows) * static_cast<Size>(first);
    for (Size strip = block; strip < strips; ++strip) {
      double* const rows_of_strip = panel + strip * strip_size;
      double* const c = rows_of_strip + kRows * first;
      if (first > 0) subtract(multiply(rows_of_strip, diagonal_strip, first), c, columns);
      if (strip == block) {
        if (!factor_diagonal(diagonal, columns, least_pivots + first)) return false;
      } else {
        solve_strip(c, diagonal, columns);
      }
    }
  }
  return true;
}

void subtract_products(const double* panel, int pivots, int rows, double* rest, Size begin, Size end) {
  const Size strip_size = static_cast<Size>(kRows) * static_cast<Size>(pivots);
  const double* const below = panel + strip_count(pivots) * strip_size;
  end = std::min(end, strip_count(rows));
  for (Size strip = begin; strip < end; ++strip)
    for (Size column = 0; column <= strip; ++column)
      subtract(multiply(below + strip * strip_size, below + column * strip_size, pivots),
               rest + rest_strip(strip) + column * kRows * kRows, kRows);
}

void multiply_lanes(const double* strip, const double* pivots, int columns, double* sums) {
  Pair wide[4][2] = {};
  for (int p = 0; p < columns; ++p, strip += kRows, pivots += kRows) {
    const Pair low = *reinterpret_cast<const Pair*>(pivots);
    const Pair high = *reinterpret_cast<const Pair*>(pivots + 2);
    for (Size i = 0; i < 4; ++i) {
      const Pair factor = {strip[i], strip[i]};
      wide[i][0] += factor * low;
      wide[i][1] += factor * high;
    }
  }
  for (Size i = 0; i < 4; ++i)
    for (Size half = 0; half < 2; ++half)
      *reinterpret_cast<Pair*>(sums + kRows * i + 2 * half) = wide[i][half];
}

void subtract_lanes(const double* strip, const double* rows, int columns, double* pivots) {
  Pair r[4][2];
  for (Size i = 0; i < 4; ++i)
    for (Size half = 0; half < 2; ++half)
      r[i][half] = *reinterpret_cast<const Pair*>(rows + kRows * i + 2 * half);
  for (int p = 0; p < columns; ++p, strip += kRows, pivots += kRows) {
    const Pair s0 = {strip[0], strip[0]}, s1 = {strip[1], strip[1]}, s2 = {strip[2], strip[2]},
               s3 = {strip[3], strip[3]};
    for (Size half = 0; half < 2; ++half)
      *reinterpret_cast<Pair*>(pivots + 2 * half) -=
          ((s0 * r[0][half] + s1 * r[1][half]) + s2 * r[2][half]) + s3 * r[3][half];
  }
}

}  // namespace

const Kernels& narrow_kernels() {
  static const Kernels kernels{factor_panel, subtract_products, multiply_lanes, subtract_lanes};
  return kernels;
}

}  // namespace shatterbox::stress::tiles
