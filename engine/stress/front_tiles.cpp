#include "engine/stress/front_tiles.h"

#include <algorithm>

#include "engine/core/elementary.h"

namespace shatterbox::stress::tiles {
namespace {

/// Cholesky of the lower triangle of a tile's first `size` columns, in place, the diagonal inverted, the
/// upper triangle set to zero.
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

}  // namespace

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

}  // namespace shatterbox::stress::tiles
