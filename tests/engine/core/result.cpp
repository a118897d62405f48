#include "engine/core/result.h"

#include <catch2/catch.hpp>
#include <memory>

namespace shatterbox::core {
namespace {

Result<std::unique_ptr<int>> half_of(int number) {
  if (number % 2 != 0) return Error{std::to_string(number) + " is odd"};
  return std::make_unique<int>(number / 2);
}

}  // namespace

TEST_CASE("a result is a value or a sentence") {
  Result<std::unique_ptr<int>> good = half_of(8);
  REQUIRE(good.ok());
  CHECK(static_cast<bool>(good));
  CHECK(*good.value() == 4);
  const std::unique_ptr<int> taken = std::move(good.value());
  CHECK(*taken == 4);
  const auto bad = half_of(7);
  CHECK_FALSE(bad.ok());
  CHECK(bad.error() == "7 is odd");
  CHECK_THROWS_WITH(bad.value(), "7 is odd");
}

}  // namespace shatterbox::core
