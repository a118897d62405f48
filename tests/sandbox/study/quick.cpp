// Every study runs, and finds the order that theory gives.
#include <catch2/catch.hpp>
#include <cmath>

#include "engine/core/parallel.h"
#include "engine/core/random.h"
#include "sandbox/study/fragments.h"
#include "sandbox/study/order.h"
#include "sandbox/study/own_reference.h"
#include "sandbox/study/scene_play.h"
#include "sandbox/study/study.h"
#include "sandbox/study/telling.h"

using namespace shatterbox::sandbox::study;

namespace {

StudyResult run_quick(const std::string& name) {
  shatterbox::core::set_thread_count(1);
  for (const Study& study : studies())
    if (study.name == name) return run_plan(study.plan(true), {true, {}});
  FAIL("there is no study " << name);
  return {};
}

const Table& table_of(const StudyResult& result, const std::string& name) {
  for (const Table& table : result.tables)
    if (table.name == name) return table;
  FAIL("there is no table " << name);
  return result.tables[0];
}

double error_at_default(const Table& table, std::size_t error = 0) {
  const auto row = default_row(table);
  REQUIRE(row);
  return table.rows[*row].errors[error];
}

}  // namespace

TEST_CASE("study motion: exact flight and bounces and the order of spin") {
  const StudyResult result = run_quick("motion");
  INFO(describe(result));
  const auto top = fit_order(table_of(result, "top"), 0);
  REQUIRE(top);
  CHECK(top->order == Approx(4.0).margin(0.1));
  CHECK(error_at_default(table_of(result, "top"), 1) < 1e-12);
  for (const Row& row : table_of(result, "throw").rows) CHECK(row.errors[0] < 1e-12);
  for (const Row& row : table_of(result, "incline").rows) CHECK(row.errors[0] < 1e-5);
  for (const Row& row : table_of(result, "bounce").rows) {
    CHECK(row.errors[0] < 1e-4);  // it bounces where it arrives, whatever the step
    CHECK(row.errors[1] < 1e-6);
  }
  for (const Row& row : table_of(result, "roll").rows) {
    CHECK(row.errors[0] < 1e-6);
    CHECK(row.errors[1] < 1e-10);
  }
  for (const Row& row : table_of(result, "stick").rows) {
    CHECK(row.errors[0] < 1e-5);
    CHECK(row.errors[2] < 4e-6);  // m in the next second: it does not creep
  }
}

TEST_CASE("study stress: elements of the first order, moments of the second") {
  const StudyResult result = run_quick("stress");
  INFO(describe(result));
  for (const char* name : {"sphere", "cylinder", "hole", "spin", "cantilever", "beam"}) {
    const auto raw = fit_order(table_of(result, name), 1), averaged = fit_order(table_of(result, name), 0);
    INFO(name);
    REQUIRE(raw);
    CHECK(raw->order == Approx(1.0).margin(0.2));
    REQUIRE(averaged);
    CHECK(averaged->order > 1.0);
  }
  for (const char* name : {"plate-hinged", "plate-clamped", "balloon"}) {
    const auto order = fit_order(table_of(result, name), 0);
    INFO(name);
    REQUIRE(order);
    CHECK(order->order == Approx(2.0).margin(0.1));
  }
  const auto disc = fit_order(table_of(result, "disc"), 1);
  REQUIRE(disc);
  CHECK(disc->order == Approx(1.0).margin(0.1));
  const auto tolerance = fit_order(table_of(result, "tolerance"), 0);
  REQUIRE(tolerance);
  CHECK(tolerance->order == Approx(1.0).margin(0.35));
  CHECK(error_at_default(table_of(result, "tolerance")) < 2e-3);
  // The paper's pins are wrong, and the more so the finer the mesh; a balanced load knows no pins.
  const auto& pins = table_of(result, "pins").rows;
  CHECK(pins.back().errors[0] > 2.0 * pins.front().errors[0]);
  for (const Row& row : pins) {
    CHECK(row.errors[1] > 10.0);
    CHECK(row.errors[2] < 1e-9);
  }
  // Membranes alone have no limit.
  const auto& membrane = table_of(result, "membrane").rows;
  CHECK(membrane.back().errors[0] > 3.0 * membrane[membrane.size() - 2].errors[0]);
  REQUIRE(result.figures.size() == 1);
  CHECK(result.figures[0].curves.size() == 2);
}

TEST_CASE("study contact: weights are carried and momentum is kept, nothing crosses, arches stand or fall") {
  const StudyResult result = run_quick("contact");
  INFO(describe(result));
  for (const char* name : {"stack", "stack-steps", "stack-substeps"})
    for (const Row& row : table_of(result, name).rows) CHECK(row.errors[0] < 1e-3);
  for (const char* name : {"heap-steps", "heap-substeps"})
    for (const Row& row : table_of(result, name).rows) {
      CHECK(row.errors[0] < 1e-3);   // of the energy at the start, in a step
      CHECK(row.errors[1] < 1e-12);  // momentum
      CHECK(row.errors[2] == 0.0);   // overlap
    }
  for (const char* name : {"gas-steps", "gas-substeps"})
    for (const Row& row : table_of(result, name).rows) {
      CHECK(row.errors[0] < 1e-3);
      CHECK(row.errors[1] < 1e-12);
      CHECK(row.errors[2] == 0.0);
      CHECK(row.errors[3] > 20.0);
    }
  for (const Row& row : table_of(result, "arch").rows) CHECK(row.errors[1] == 0.0);
  for (const Row& row : table_of(result, "boats").rows) CHECK(row.errors[0] + row.errors[1] == 0.0);
  for (const Row& row : table_of(result, "boats-paper").rows) CHECK(row.errors[0] + row.errors[1] > 0.0);
}

TEST_CASE("study step-size: one stress whatever the step, and the right verdict at rest") {
  const StudyResult result = run_quick("step-size");
  INFO(describe(result));
  const Table& hit = table_of(result, "hit");
  for (const Row& row : hit.rows) CHECK(row.errors[0] < 0.01);
  // An impulse that is spread over the step has a stress in proportion to the steps a second.
  CHECK(hit.rows.back().errors[3] / hit.rows.front().errors[3] == Approx(8.0).epsilon(0.05));
  for (const Row& row : table_of(result, "rest").rows) CHECK(row.errors[0] == 0.0);
  CHECK(error_at_default(table_of(result, "break")) < 0.25);
}

TEST_CASE("study refine: means over flaw seeds hardly know the mesh") {
  const StudyResult result = run_quick("refine");
  INFO(describe(result));
  for (const Row& row : table_of(result, "bauble").rows) {
    CHECK(row.errors[0] < 0.25);
    CHECK(row.errors[2] > 5.0);
    CHECK(row.errors[5] < 1.0);  // cracks never use more than there is
  }
}

TEST_CASE("study scaling: factors and solves grow as theory says") {
  const StudyResult result = run_quick("scaling");
  INFO(describe(result));
  // Counts, which no clock disturbs: entries of the factor n log n, iterations at most n^(1/3), as without
  // clusters.
  const auto entries = fit_order(table_of(result, "pane"), 2);
  REQUIRE(entries);
  CHECK(entries->order == Approx(1.1).margin(0.15));
  const Row &small = table_of(result, "cube").rows.front(), &large = table_of(result, "cube").rows.back();
  CAPTURE(small.errors[2], large.errors[2]);
  CHECK(large.errors[2] <= 1.1 * std::cbrt(large.value / small.value) * small.errors[2]);
  REQUIRE(table_of(result, "bodies").rows.size() == 3);
  for (const Row& row : table_of(result, "bodies").rows) CHECK(row.errors[1] > 0.0);
  REQUIRE(result.figures.size() == 1);
}

TEST_CASE("a scene beside itself at a finer step") {
  const auto scene = scene_of(R"([scene]
name = "thrown"
seconds = 0.5
[[body]]
kind = "plane"
material = "concrete"
[[body]]
kind = "sphere"
radius = 0.1
material = "steel"
position = [0, 0.6, 0]
velocity = [1, 0, 0]
)",
                              {});
  const StudyResult result = run_plan(scene_study(scene).plan(false), {true, {}});
  INFO(describe(result));
  const Table& table = table_of(result, "thrown");
  REQUIRE(table.rows.size() == 4);
  REQUIRE(table_of(result, "thrown-substeps").rows.size() == 5);
  CHECK(error_at_default(table_of(result, "thrown-substeps")) < 0.02);
  CHECK(error_at_default(table) < 0.02);
  CHECK(table.rows.back().errors[0] < table.rows.front().errors[0]);
  for (const Row& row : table.rows) {
    CHECK(row.errors[2] == 0.0);  // nothing breaks
    CHECK(row.errors[3] == 0.0);
  }
}

TEST_CASE("study dynamics: waves that die out leave the balanced stress, a window the screened one") {
  const StudyResult result = run_quick("dynamics");
  INFO(describe(result));
  const auto& waves = table_of(result, "waves").rows;
  CHECK(waves[0].errors[0] > 10.0 * waves[1].errors[0]);
  CHECK(waves[1].errors[0] < 2e-3);  // over twelve periods
  for (const Row& row : table_of(result, "window").rows) {
    CHECK(row.errors[0] < 0.01);
    CHECK(row.errors[1] > 2.0 * row.errors[0]);
  }
  REQUIRE(result.conclusions.size() == 1);
}

TEST_CASE("study fragments: pieces of every size") {
  const StudyResult result = run_quick("fragments");
  INFO(describe(result));
  for (const Row& row : table_of(result, "sizes").rows) CHECK(row.errors[3] > 5.0);
  for (const Row& row : table_of(result, "radial").rows) CHECK(row.errors[0] > 3.0);
  // As many as the stored energy pays for: 55.8 of 6 mm of tempered glass.
  for (const Row& row : table_of(result, "tempered").rows) {
    CHECK(row.errors[0] == 0.0);
    CHECK(row.errors[2] == Approx(55.8).epsilon(0.1));
  }
}

TEST_CASE("the exponent of a power law is found with its interval") {
  // The quantiles of m^-1.5 above 1.
  std::vector<double> masses;
  for (int i = 0; i < 4000; ++i) masses.push_back(std::pow(1.0 - (i + 0.5) / 4000.0, -2.0));
  const PowerLaw law = fit_power_law(masses, 1.0);
  CHECK(law.exponent == Approx(1.5).epsilon(1e-3));
  CHECK(law.half_width == Approx(1.96 * 0.5 / std::sqrt(4000.0)).epsilon(0.01));
  CHECK(law.count == 4000);
  CHECK(fit_power_law(masses, 4.0).exponent == Approx(1.5).epsilon(1e-2));
  CHECK(std::isnan(fit_power_law({1.0}, 1.0).exponent));
  CHECK(law.is_one());
}

TEST_CASE("samples of a power law are told from what is none") {
  shatterbox::core::Random random(11, 0);
  int ones = 0;
  for (int round = 0; round < 400; ++round) {
    std::vector<double> masses;
    for (int i = 0; i < 250; ++i) masses.push_back(std::pow(random.uniform(1e-9, 1.0), -1.25));
    ones += fit_power_law(masses, 1.0).is_one() ? 1 : 0;
  }
  CHECK(ones >= 370);  // 380 are expected, and 4.4 the standard deviation
  CHECK(ones <= 390);
  std::vector<double> even;
  for (int i = 0; i < 250; ++i) even.push_back(1.0 + 0.01 * i);
  CHECK_FALSE(fit_power_law(even, 1.0).is_one());
}
