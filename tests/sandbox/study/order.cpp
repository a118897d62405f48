// The order of convergence and the cheapest setting, on rows whose answer is known.
#include "sandbox/study/order.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "sandbox/study/study.h"

using namespace shatterbox::sandbox::study;

namespace {

/// Rows at steps 1/30, 1/60, ... whose first error is `error(step)`; time grows as the number of steps.
template <class Error>
Table table_of(int count, const Error& error) {
  Table table;
  table.error_names = {"error"};
  for (int i = 0; i < count; ++i) {
    const double step = 1.0 / (30 << i);
    Row row;
    row.setting = std::to_string(30 << i);
    row.value = step;
    row.errors = {error(step)};
    row.seconds = 1e-3 / step;
    table.rows.push_back(row);
  }
  return table;
}

}  // namespace

TEST_CASE("exact powers have their order") {
  for (const double order : {0.5, 1.0, 2.0, 4.0}) {
    const auto fit = fit_order(table_of(8, [&](double h) { return 3.0 * std::pow(h, order); }), 0);
    REQUIRE(fit);
    CHECK(fit->order == Approx(order).epsilon(1e-10));
    CHECK(fit->spread < 1e-9);
    CHECK(fit->rows.size() >= 5);
  }
}

TEST_CASE("what is not asymptotic, and what is rounding, is left out") {
  // A plateau at both ends of h^2.
  const auto table =
      table_of(8, [](double h) { return std::min(0.5, 4e3 * h * h) + (h < 1.0 / 1000.0 ? 5e-3 : 0.0); });
  const auto fit = fit_order(table, 0);
  REQUIRE(fit);
  CHECK(fit->order == Approx(2.0).epsilon(1e-9));
  CHECK(fit->rows == std::vector<int>{2, 3, 4, 5});
  CHECK(fit->is_at_end);
}

TEST_CASE("no order where there is none") {
  CHECK_FALSE(fit_order(table_of(8, [](double) { return 0.1; }), 0));
  CHECK_FALSE(fit_order(table_of(8, [](double h) { return 1e-3 / h; }), 0));
  CHECK_FALSE(fit_order(table_of(8, [](double h) { return 1e-15 * h; }), 0));
  CHECK_FALSE(fit_order(table_of(2, [](double h) { return h; }), 0));
  CHECK_FALSE(fit_order(table_of(5, [](double h) { return h; }), 1));  // there is no second error
  CHECK_FALSE(fit_order(table_of(5, [](double) { return kNoNumber; }), 0));
}

TEST_CASE("the cheapest setting that is good enough, and stays so") {
  auto table = table_of(8, [](double h) { return h; });
  CHECK(table.rows[*cheapest_row(table, 0.01)].setting == "120");
  CHECK(table.rows[*cheapest_row(table, 0.001)].setting == "1920");
  CHECK_FALSE(cheapest_row(table, 1e-5));
  // Right by luck: a finer one is not.
  table.rows[0].errors[0] = 0.0;
  CHECK(table.rows[*cheapest_row(table, 0.01)].setting == "120");
  // A finer setting that happens to be cheaper.
  table.rows[5].seconds = 0.0;
  CHECK(table.rows[*cheapest_row(table, 0.01)].setting == "960");
  // What was not timed, or not measured, is no answer.
  for (Row& row : table.rows) row.seconds = kNoNumber;
  CHECK_FALSE(cheapest_row(table, 0.01));
}

TEST_CASE("the first call of a row is not timed") {
  int calls = 0;
  Plan plan;
  plan.tables.emplace_back();
  plan.jobs.push_back({0, "cold", 1.0, true, [&calls]() -> Measured {
                         return {{0.5}, calls++ == 0 ? 0.9 : 0.1 * calls, "noted"};
                       }});
  for (const bool is_quick : {true, false}) {
    calls = 0;
    const StudyResult result = run_plan(plan, {is_quick, {}});
    REQUIRE(result.tables[0].rows.size() == 1);
    const Row& row = result.tables[0].rows[0];
    CHECK(row.seconds == Approx(is_quick ? 0.2 : 0.4));  // of 0.2, 0.3, 0.4, 0.5, 0.6
    CHECK(row.is_default);
    CHECK(row.note == "noted");
    CHECK(result.is_whole);
  }
  const StudyResult stopped = run_plan(plan, {true, [](int, int, const std::string&) { return false; }});
  CHECK_FALSE(stopped.is_whole);
  CHECK(stopped.tables[0].rows.empty());
}
