// What rows say together: the order of convergence, and the cheapest setting that is good enough.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "sandbox/study/table.h"

namespace shatterbox::sandbox::study {

/// error = factor * value ^ order over the asymptotic rows.
struct Order {
  double order = 0.0;
  double spread = 0.0;     // greatest distance of a neighbours' order from `order`
  std::vector<int> rows;   // that were used, ascending
  bool is_at_end = false;  // finer rows than these gain nothing: rounding, or another error, rules there
};

/// Fits the order of error number `error` by least squares of logarithms. The asymptotic part is the longest
/// run of neighbouring rows (by value; at least three, of equals the straightest) over which the order from
/// each row to the next stays near that of the fit. Nothing without such a run, or where it gains next to
/// nothing.
std::optional<Order> fit_order(const Table& table, std::size_t error);

/// Number of the row of least run time among those from which on (finer, by value; without values: that) the
/// first error is within `bound`; nothing if there is none.
std::optional<std::size_t> cheapest_row(const Table& table, double bound);

/// Number of the default's row.
std::optional<std::size_t> default_row(const Table& table);

/// The slope of y over x by least squares; at least two different x.
double least_squares_slope(const std::vector<double>& x, const std::vector<double>& y);

}  // namespace shatterbox::sandbox::study
