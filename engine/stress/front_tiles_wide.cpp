// The kernels of front_tiles.cpp with four lanes an instruction, where the processor has AVX. Each entry is
// the same products summed in the same order, and no multiplication is fused with an addition: the same bits.
#include "engine/stress/front_tiles.h"

#if defined(__x86_64__) && defined(__GNUC__)
#define SHATTERBOX_WIDE __attribute__((target("avx")))

namespace shatterbox::stress::tiles {
namespace {

/// Four rows of a column, at any address.
typedef double Quad __attribute__((vector_size(32), aligned(8), may_alias));

SHATTERBOX_WIDE inline Quad load(const double* p) {
  return *reinterpret_cast<const Quad*>(p);
}

SHATTERBOX_WIDE inline void store(double* p, const Quad& q) {
  *reinterpret_cast<Quad*>(p) = q;
}

/// Four columns of one strip, then of the next one.
struct WideTile {
  Quad first[4];
  Quad second[4];
};

/// Rows of strips a and b times the strip c transposed.
SHATTERBOX_WIDE inline void multiply_two(const double* a, const double* b, const double* c, int depth,
                                         WideTile& out) {
  Quad a0 = {}, a1 = {}, a2 = {}, a3 = {}, b0 = {}, b1 = {}, b2 = {}, b3 = {};
  for (int p = 0; p < depth; ++p, a += kRows, b += kRows, c += kRows) {
    const Quad x = load(a), y = load(b);
    const Quad c0 = {c[0], c[0], c[0], c[0]}, c1 = {c[1], c[1], c[1], c[1]};
    a0 += x * c0;
    b0 += y * c0;
    a1 += x * c1;
    b1 += y * c1;
    const Quad c2 = {c[2], c[2], c[2], c[2]}, c3 = {c[3], c[3], c[3], c[3]};
    a2 += x * c2;
    b2 += y * c2;
    a3 += x * c3;
    b3 += y * c3;
  }
  out = {{a0, a1, a2, a3}, {b0, b1, b2, b3}};
}

SHATTERBOX_WIDE inline void multiply_one(const double* a, const double* c, int depth, Quad out[4]) {
  Quad a0 = {}, a1 = {}, a2 = {}, a3 = {};
  for (int p = 0; p < depth; ++p, a += kRows, c += kRows) {
    const Quad x = load(a);
    const Quad c0 = {c[0], c[0], c[0], c[0]}, c1 = {c[1], c[1], c[1], c[1]};
    const Quad c2 = {c[2], c[2], c[2], c[2]}, c3 = {c[3], c[3], c[3], c[3]};
    a0 += x * c0;
    a1 += x * c1;
    a2 += x * c2;
    a3 += x * c3;
  }
  out[0] = a0;
  out[1] = a1;
  out[2] = a2;
  out[3] = a3;
}

SHATTERBOX_WIDE inline void subtract_columns(const Quad t[4], double* c, int columns) {
  for (int j = 0; j < columns; ++j) store(c + kRows * j, load(c + kRows * j) - t[j]);
}

/// c <- c L^-T for `columns` columns of a strip, L a factored diagonal tile.
SHATTERBOX_WIDE inline void solve_columns(double* c, const double* diagonal, int columns) {
  Quad x[4];
  for (int j = 0; j < columns; ++j) {
    x[j] = load(c + kRows * j);
    for (int q = 0; q < j; ++q) {
      const double factor = diagonal[kRows * q + j];
      x[j] -= x[q] * Quad{factor, factor, factor, factor};
    }
    const double inverse = diagonal[kRows * j + j];
    x[j] *= Quad{inverse, inverse, inverse, inverse};
    store(c + kRows * j, x[j]);
  }
}

SHATTERBOX_WIDE bool factor_panel_wide(double* panel, int pivots, int rows, const double* least_pivots) {
  const Size strip_size = static_cast<Size>(kRows) * static_cast<Size>(pivots);
  const Size pivot_strips = strip_count(pivots);
  const Size strips = pivot_strips + strip_count(rows);
  WideTile t;
  for (Size block = 0; block < pivot_strips; ++block) {
    const int first = kRows * static_cast<int>(block);
    const int columns = pivots - first < kRows ? pivots - first : kRows;
    double* const diagonal_strip = panel + block * strip_size;
    double* const diagonal = diagonal_strip + kRows * first;
    if (first > 0) {
      multiply_one(diagonal_strip, diagonal_strip, first, t.first);
      subtract_columns(t.first, diagonal, columns);
    }
    if (!factor_diagonal(diagonal, columns, least_pivots + first)) return false;
    Size strip = block + 1;
    for (; strip + 1 < strips; strip += 2) {
      double* const a = panel + strip * strip_size;
      double* const b = a + strip_size;
      if (first > 0) {
        multiply_two(a, b, diagonal_strip, first, t);
        subtract_columns(t.first, a + kRows * first, columns);
        subtract_columns(t.second, b + kRows * first, columns);
      }
      solve_columns(a + kRows * first, diagonal, columns);
      solve_columns(b + kRows * first, diagonal, columns);
    }
    if (strip < strips) {
      double* const a = panel + strip * strip_size;
      if (first > 0) {
        multiply_one(a, diagonal_strip, first, t.first);
        subtract_columns(t.first, a + kRows * first, columns);
      }
      solve_columns(a + kRows * first, diagonal, columns);
    }
  }
  return true;
}

SHATTERBOX_WIDE void subtract_products_wide(const double* panel, int pivots, int rows, double* rest,
                                            Size begin, Size end) {
  const Size strip_size = static_cast<Size>(kRows) * static_cast<Size>(pivots);
  const double* const below = panel + strip_count(pivots) * strip_size;
  if (end > strip_count(rows)) end = strip_count(rows);
  constexpr Size kTile = kRows * kRows;
  WideTile t;
  Size strip = begin;
  for (; strip + 1 < end; strip += 2) {
    const double* const a = below + strip * strip_size;
    const double* const b = a + strip_size;
    double* const rest_a = rest + rest_strip(strip);
    double* const rest_b = rest + rest_strip(strip + 1);
    for (Size column = 0; column <= strip; ++column) {
      multiply_two(a, b, below + column * strip_size, pivots, t);
      subtract_columns(t.first, rest_a + column * kTile, kRows);
      subtract_columns(t.second, rest_b + column * kTile, kRows);
    }
    multiply_one(b, b, pivots, t.first);
    subtract_columns(t.first, rest_b + (strip + 1) * kTile, kRows);
  }
  for (; strip < end; ++strip)
    for (Size column = 0; column <= strip; ++column) {
      multiply_one(below + strip * strip_size, below + column * strip_size, pivots, t.first);
      subtract_columns(t.first, rest + rest_strip(strip) + column * kTile, kRows);
    }
}

SHATTERBOX_WIDE void multiply_lanes_wide(const double* strip, const double* pivots, int columns,
                                         double* sums) {
  Quad s0 = {}, s1 = {}, s2 = {}, s3 = {};
  for (int p = 0; p < columns; ++p, strip += kRows, pivots += kRows) {
    const Quad x = load(pivots);
    s0 += Quad{strip[0], strip[0], strip[0], strip[0]} * x;
    s1 += Quad{strip[1], strip[1], strip[1], strip[1]} * x;
    s2 += Quad{strip[2], strip[2], strip[2], strip[2]} * x;
    s3 += Quad{strip[3], strip[3], strip[3], strip[3]} * x;
  }
  store(sums, s0);
  store(sums + kRows, s1);
  store(sums + 2 * kRows, s2);
  store(sums + 3 * kRows, s3);
}

SHATTERBOX_WIDE void subtract_lanes_wide(const double* strip, const double* rows, int columns,
                                         double* pivots) {
  const Quad r0 = load(rows), r1 = load(rows + kRows), r2 = load(rows + 2 * kRows),
             r3 = load(rows + 3 * kRows);
  for (int p = 0; p < columns; ++p, strip += kRows, pivots += kRows) {
    const Quad s0 = {strip[0], strip[0], strip[0], strip[0]}, s1 = {strip[1], strip[1], strip[1], strip[1]},
               s2 = {strip[2], strip[2], strip[2], strip[2]}, s3 = {strip[3], strip[3], strip[3], strip[3]};
    store(pivots, load(pivots) - (((s0 * r0 + s1 * r1) + s2 * r2) + s3 * r3));
  }
}

}  // namespace

const Kernels* wide_kernels() {
  static const Kernels kernels{factor_panel_wide, subtract_products_wide, multiply_lanes_wide,
                               subtract_lanes_wide};
  return __builtin_cpu_supports("avx") ? &kernels : nullptr;
}

}  // namespace shatterbox::stress::tiles

#else

namespace shatterbox::stress::tiles {

const Kernels* wide_kernels() {
  return nullptr;
}

}  // namespace shatterbox::stress::tiles

#endif
