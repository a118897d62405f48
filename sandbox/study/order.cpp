#include "sandbox/study/order.h"

#include <algorithm>
#include <cmath>

namespace shatterbox::sandbox::study {

namespace {

/// Below this a relative error is rounding.
constexpr double kRounding = 2e-13;
/// How far the order from one row to the next may lie from that of the fit.
constexpr double kMostSpread = 0.55;
/// An order below this gains next to nothing.
constexpr double kLeastOrder = 0.25;

struct Point {
  int row = 0;
  double log_value = 0.0, log_error = 0.0;
};

/// Rows with a value and an error above rounding, from the coarsest to the finest.
std::vector<Point> points_of(const Table& table, std::size_t error) {
  std::vector<Point> points;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const Row& row = table.rows[i];
    const double e = error < row.errors.size() ? std::abs(row.errors[error]) : kNoNumber;
    if (!(row.value > 0.0) || !std::isfinite(row.value) || !std::isfinite(e)) continue;
    if (e < kRounding) continue;
    points.push_back({static_cast<int>(i), std::log(row.value), std::log(e)});
  }
  std::stable_sort(points.begin(), points.end(),
                   [](const Point& a, const Point& b) { return a.log_value > b.log_value; });
  return points;
}

/// The fit over points [first, last]; nothing if they are not on one line.
std::optional<Order> fit_points(const std::vector<Point>& points, std::size_t first, std::size_t last) {
  Order order;
  std::vector<double> x, y;
  for (std::size_t i = first; i <= last; ++i) {
    x.push_back(points[i].log_value);
    y.push_back(points[i].log_error);
    order.rows.push_back(points[i].row);
  }
  order.order = least_squares_slope(x, y);
  for (std::size_t i = 0; i + 1 < x.size(); ++i)
    order.spread = std::max(order.spread, std::abs((y[i] - y[i + 1]) / (x[i] - x[i + 1]) - order.order));
  if (!(order.order >= kLeastOrder) || !(order.spread <= kMostSpread)) return std::nullopt;
  std::sort(order.rows.begin(), order.rows.end());
  return order;
}

}  // namespace

double least_squares_slope(const std::vector<double>& x, const std::vector<double>& y) {
  double mean_x = 0.0, mean_y = 0.0, up = 0.0, down = 0.0;
  const auto n = static_cast<double>(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    mean_x += x[i] / n;
    mean_y += y[i] / n;
  }
  for (std::size_t i = 0; i < x.size(); ++i) {
    up += (x[i] - mean_x) * (y[i] - mean_y);
    down += (x[i] - mean_x) * (x[i] - mean_x);
  }
  return up / down;
}

std::optional<Order> fit_order(const Table& table, std::size_t error) {
  const std::vector<Point> points = points_of(table, error);
  const auto with_value =
      std::count_if(table.rows.begin(), table.rows.end(), [](const Row& row) { return row.value > 0.0; });
  std::optional<Order> best;
  for (std::size_t count = points.size(); count >= 3 && !best; --count)
    for (std::size_t last = points.size() - 1; last + 1 >= count; --last) {
      std::optional<Order> order = fit_points(points, last + 1 - count, last);
      if (!order || (best && best->spread <= order->spread)) continue;
      order->is_at_end = last + 1 < static_cast<std::size_t>(with_value);
      best = order;
    }
  return best;
}

std::optional<std::size_t> cheapest_row(const Table& table, double bound) {
  const auto error_of = [](const Row& row) {
    return row.errors.empty() || std::isnan(row.errors[0]) ? std::numeric_limits<double>::infinity()
                                                           : std::abs(row.errors[0]);
  };
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const Row& row = table.rows[i];
    // A coarse setting that is right by luck, while a finer one is not, is not good enough.
    const bool is_lucky = std::any_of(table.rows.begin(), table.rows.end(), [&](const Row& other) {
      return other.value < row.value && error_of(other) > bound;
    });
    if (error_of(row) > bound || is_lucky || std::isnan(row.seconds)) continue;
    if (!best || row.seconds < table.rows[*best].seconds) best = i;
  }
  return best;
}

std::optional<std::size_t> default_row(const Table& table) {
  for (std::size_t i = 0; i < table.rows.size(); ++i)
    if (table.rows[i].is_default) return i;
  return std::nullopt;
}

}  // namespace shatterbox::sandbox::study
