// What a study writes: the CSV comes back as it was, the words follow from the numbers.
#include "sandbox/study/telling.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "sandbox/study/plot.h"
#include "sandbox/study/spin_top.h"

using namespace shatterbox::sandbox::study;

namespace {

std::vector<Table> two_tables() {
  Table first;
  first.name = "slide";
  first.what = "a box slides";
  first.setting_name = "steps a second";
  first.value_name = "step, s";
  first.error_names = {"way", "lift, m"};
  first.theory = {1.0};
  for (int i = 0; i < 4; ++i) {
    Row row;
    row.setting = std::to_string(30 << i);
    row.value = 1.0 / (30 << i);
    row.errors = {0.3 * row.value, i == 2 ? kNoNumber : 0.1 / 3.0};
    row.seconds = 1e-3 * (i + 1);
    row.is_default = i == 1;
    row.note = i == 3 ? "said \"so\", in\ntwo lines" : "";
    first.rows.push_back(row);
  }
  Table second;
  second.name = "other";
  second.error_names = {"stress"};
  second.rows.emplace_back();
  second.rows[0].errors = {1e-300};
  return {first, second};
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("a CSV read back is what was written") {
  const auto tables = two_tables();
  const std::string text = to_csv(tables);
  const auto back = from_csv(text);
  REQUIRE(back);
  CHECK(to_csv(*back) == text);
  REQUIRE(back->size() == 2);
  CHECK((*back)[0].error_names == tables[0].error_names);
  for (std::size_t i = 0; i < 4; ++i) {
    const Row &row = (*back)[0].rows[i], &expected = tables[0].rows[i];
    CHECK(row.setting == expected.setting);
    CHECK(row.value == expected.value);
    CHECK(row.seconds == expected.seconds);
    CHECK(row.errors[0] == expected.errors[0]);
    CHECK(std::isnan(row.errors[1]) == std::isnan(expected.errors[1]));
    CHECK(row.is_default == expected.is_default);
    CHECK(row.note == expected.note);
  }
  CHECK(std::isnan((*back)[1].rows[0].seconds));
  CHECK((*back)[1].rows[0].errors[0] == 1e-300);
  CHECK_FALSE(from_csv("a,b\n1,2\n"));
  CHECK_FALSE(from_csv(text + "slide,too,short\n"));
}

TEST_CASE("a paragraph says order, default and what is cheapest") {
  const std::string text = describe_table(two_tables()[0]);
  INFO(text);
  CHECK(has(text, "Observed order 1.00 over 4 settings (30 to 240 steps a second); theory: 1."));
  CHECK(has(text, "Default: 60 steps a second (0.5 %, 2 ms), lift, m 0.0333."));
  CHECK(has(text, "Cheapest for 1 %: 30 steps a second (1 %, 1 ms); for 0.1 %: none of these."));
  CHECK(has(text, "240: said \"so\""));
  const std::string summary = summary_rows({two_tables(), {}, {}, true});
  CHECK(summary == "| slide | a box slides | 0.5 % (way) | 2 ms | 30 steps a second (1 ms) |\n");
}

TEST_CASE("a plot has a curve for each table that was timed") {
  const std::string commands = plot_commands(two_tables(), "a \"title\"", "name");
  CHECK(has(commands, "set logscale xy"));
  CHECK(has(commands, "\"name.png\""));
  CHECK(has(commands, "\"name.svg\""));
  CHECK(has(commands, "a \\\"title\\\""));
  CHECK(has(commands, "slide: way"));
  CHECK_FALSE(has(commands, "other"));  // no time
  CHECK(plot_commands({}, "", "").empty());
}

TEST_CASE("Jacobi's functions: identities, and their values at the quarter period") {
  for (const double m : {0.1, 0.5, 0.9}) {
    for (const double u : {-2.0, 0.3, 1.7, 20.0}) {
      const JacobiFunctions j = jacobi_functions(u, m);
      CHECK(j.sn * j.sn + j.cn * j.cn == Approx(1.0).epsilon(1e-13));
      CHECK(j.dn * j.dn + m * j.sn * j.sn == Approx(1.0).epsilon(1e-13));
      const double h = 1e-5;  // sn' = cn dn
      CHECK((jacobi_functions(u + h, m).sn - jacobi_functions(u - h, m).sn) / (2.0 * h) ==
            Approx(j.cn * j.dn).margin(1e-9));
    }
  }
  const double quarter = 1.8540746773013719;  // K(m = 0.5), Abramowitz & Stegun table 17.1
  CHECK(jacobi_functions(quarter, 0.5).sn == Approx(1.0).epsilon(1e-13));
  CHECK(jacobi_functions(quarter, 0.5).dn == Approx(std::sqrt(0.5)).epsilon(1e-13));
}
