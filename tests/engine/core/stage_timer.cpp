#include "engine/core/stage_timer.h"

#include <catch2/catch.hpp>
#include <stdexcept>

namespace shatterbox::core {

TEST_CASE("stages are listed in the order of their first call, with calls and sums") {
  StageTimer timer;
  timer.add("stress", 2.0);
  timer.add("contact", 1.0);
  timer.add("stress", 3.5);
  REQUIRE(timer.stages().size() == 2);
  CHECK(timer.stages()[0].name == "stress");
  CHECK(timer.stages()[0].calls == 2);
  CHECK(timer.milliseconds("stress") == 5.5);
  CHECK(timer.milliseconds("contact") == 1.0);
  CHECK(timer.milliseconds("never") == 0.0);
  timer.clear();
  CHECK(timer.stages().empty());
}

TEST_CASE(
    "timed work returns what it returns, by value, by reference, or nothing, and is booked when it throws") {
  StageTimer timer;
  int number = 3;
  CHECK(timer.time("value", [] { return 7; }) == 7);
  int& same = timer.time("reference", [&]() -> int& { return number; });
  same = 5;
  CHECK(number == 5);
  timer.time("nothing", [] {});
  CHECK_THROWS_AS(timer.time("throws", []() -> int { throw std::runtime_error("no"); }), std::runtime_error);
  REQUIRE(timer.stages().size() == 4);
  for (const auto& stage : timer.stages()) {
    CHECK(stage.calls == 1);
    CHECK(stage.milliseconds >= 0.0);
  }
}

}  // namespace shatterbox::core
