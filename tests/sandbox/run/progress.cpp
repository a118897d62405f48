// The time still needed, as the bar tells it.
#include "sandbox/run/progress.h"

#include <catch2/catch.hpp>

using shatterbox::sandbox::run::remaining_seconds;

TEST_CASE("a steady run says what is left") {
  std::deque<std::pair<double, int>> history;
  for (int i = 1; i <= 50; ++i) history.emplace_back(0.1 * i, i);
  CHECK(remaining_seconds(history, 100) == Approx(5.0).epsilon(0.02));
}

TEST_CASE("a run that has become slower says so") {
  std::deque<std::pair<double, int>> history;
  for (int i = 1; i <= 40; ++i) history.emplace_back(0.1 * i, i);
  for (int i = 1; i <= 20; ++i) history.emplace_back(4.0 + 1.0 * i, 40 + i);
  CHECK(remaining_seconds(history, 100) == Approx(40.0).epsilon(0.05));
}

TEST_CASE("nothing is promised at the start") {
  CHECK(remaining_seconds({}, 100) < 0.0);
  CHECK(remaining_seconds({{0.1, 1}, {0.2, 2}}, 100) < 0.0);
}
