// Dense kernels of a front. A panel holds its columns in strips of four rows (element (i, j) of a strip of
// rows i..i+3 is at 4 j + i mod 4), a rest matrix its lower triangle in strips as well. Lanes are fixed: two
// doubles an instruction with SSE2, the same operations in the same order without it.
#pragma once

#include <cstddef>

namespace shatterbox::stress::tiles {

using Size = std::size_t;

/// Two lanes, at any address.
typedef double Pair __attribute__((vector_size(16), aligned(8), may_alias));

inline constexpr int kRows = 4;
inline Size strip_count(int rows) {
  return static_cast<Size>((rows + kRows - 1) / kRows);
}

/// Doubles in a panel.
inline Size panel_size(int pivots, int rows) {
  return (strip_count(pivots) + strip_count(rows)) * kRows * static_cast<Size>(pivots);
}
/// Doubles in a rest matrix of `rows` rows: strip s holds 4 (s + 1) columns.
inline Size rest_size(int rows) {
  return 2 * kRows * strip_count(rows) * (strip_count(rows) + 1);
}
inline Size rest_strip(Size strip) {
  return 2 * kRows * strip * (strip + 1);
}

/// Four columns of four rows, in registers.
struct Tile {
  Pair low[4];   // rows 0, 1 of each column
  Pair high[4];  // rows 2, 3
};

/// sum over p < depth of a[4 p .. 4 p + 3] times b[4 p .. 4 p + 3] transposed.
inline Tile multiply(const double* a, const double* b, int depth) {
  Tile t{};
  for (int p = 0; p < depth; ++p, a += kRows, b += kRows) {
    const Pair a0 = *reinterpret_cast<const Pair*>(a);
    const Pair a1 = *reinterpret_cast<const Pair*>(a + 2);
    const Pair b0 = {b[0], b[0]}, b1 = {b[1], b[1]}, b2 = {b[2], b[2]}, b3 = {b[3], b[3]};
    t.low[0] += a0 * b0;
    t.high[0] += a1 * b0;
    t.low[1] += a0 * b1;
    t.high[1] += a1 * b1;
    t.low[2] += a0 * b2;
    t.high[2] += a1 * b2;
    t.low[3] += a0 * b3;
    t.high[3] += a1 * b3;
  }
  return t;
}

/// c -= t, c four (or fewer) columns of a strip.
inline void subtract(const Tile& t, double* c, int columns) {
  for (int j = 0; j < columns; ++j) {
    *reinterpret_cast<Pair*>(c + kRows * j) -= t.low[j];
    *reinterpret_cast<Pair*>(c + kRows * j + 2) -= t.high[j];
  }
}

/// Cholesky of the lower triangle of a tile's first `size` columns, in place, the diagonal inverted, the
/// upper triangle set to zero. False if a pivot is at most its entry of `least_pivots`.
bool factor_diagonal(double* tile, int size, const double* least_pivots);

/// The loops that the time goes into, for one width of the processor's registers.
struct Kernels {
  /// Factors the pivots of a panel and finishes its rows below; the diagonal becomes its inverse. False if a
  /// pivot is at most its entry of `least_pivots` (|pivots|).
  bool (*factor_panel)(double* panel, int pivots, int rows, const double* least_pivots);
  /// rest -= L L^T for the strips [begin, end) of the rest matrix, L the rows below of a finished panel.
  void (*subtract_products)(const double* panel, int pivots, int rows, double* rest, Size begin, Size end);
  /// sums (4 rows x 4 lanes) = four rows of a strip times the first `columns` pivots of four lanes.
  void (*multiply_lanes)(const double* strip, const double* pivots, int columns, double* sums);
  /// pivots -= the first `columns` columns of a strip, transposed, times its four rows (4 rows x 4 lanes).
  void (*subtract_lanes)(const double* strip, const double* rows, int columns, double* pivots);
};

/// Two doubles an instruction, on any processor.
const Kernels& narrow_kernels();
/// Four doubles an instruction; null where the processor cannot. The same bits as the narrow ones.
const Kernels* wide_kernels();

/// The widest there are.
inline const Kernels& kernels() {
  static const Kernels* const widest = wide_kernels() ? wide_kernels() : &narrow_kernels();
  return *widest;
}

}  // namespace shatterbox::stress::tiles
