#include "engine/core/random.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>

namespace shatterbox::core {

TEST_CASE("a stream is resumed by copying it, and depends on seed, stream and number only") {
  Random a(7, 3);
  for (int i = 0; i < 10; ++i) a.bits();
  Random b = a;
  for (int i = 0; i < 100; ++i) CHECK(a.bits() == b.bits());
  CHECK(Random(7, 3).bits() == Random(7, 3).bits());
  CHECK(Random(7, 3).bits() != Random(7, 4).bits());
  CHECK(Random(7, 3).bits() != Random(8, 3).bits());
}

TEST_CASE("uniform numbers are uniform and do not follow each other") {
  for (const std::uint64_t seed : {0u, 1u, 2u}) {
    Random random(seed);
    constexpr int kDraws = 200000;
    std::array<int, 64> counts{};
    double mean = 0.0;
    double product = 0.0;
    double last = random.uniform();
    for (int i = 0; i < kDraws; ++i) {
      const double u = random.uniform();
      REQUIRE(u >= 0.0);
      REQUIRE(u < 1.0);
      ++counts[static_cast<std::size_t>(u * 64.0)];
      mean += u / kDraws;
      product += (u - 0.5) * (last - 0.5) / kDraws;
      last = u;
    }
    double chi_squared = 0.0;
    for (const int count : counts) chi_squared += std::pow(count - kDraws / 64.0, 2) / (kDraws / 64.0);
    CHECK(chi_squared < 63.0 + 5.0 * std::sqrt(2.0 * 63.0));
    CHECK(std::abs(mean - 0.5) < 5.0 / std::sqrt(12.0 * kDraws));
    CHECK(std::abs(product) < 5.0 / 12.0 / std::sqrt(kDraws));
  }
}

TEST_CASE("neighbouring seeds and streams are independent") {
  double product = 0.0;
  constexpr int kStreams = 50000;
  for (std::uint64_t s = 0; s < kStreams; ++s) {
    Random a(s, 0);
    Random b(s + 1, 0);
    Random c(s, 1);
    const double u = a.uniform() - 0.5;
    product += u * (b.uniform() - 0.5) + u * (c.uniform() - 0.5);
  }
  CHECK(std::abs(product / kStreams) < 5.0 * std::sqrt(2.0) / 12.0 / std::sqrt(kStreams));
}

TEST_CASE("whole numbers cover their range evenly") {
  Random random(9);
  std::array<int, 7> counts{};
  for (int i = 0; i < 70000; ++i) ++counts[random.index(7)];
  for (const int count : counts) CHECK(count == Approx(10000).margin(5.0 * 93.0));
  for (int i = 0; i < 100; ++i) CHECK(random.index(1) == 0);
  for (int i = 0; i < 1000; ++i) {
    const double u = random.uniform(-3.0, 5.0);
    CHECK(u >= -3.0);
    CHECK(u < 5.0);
  }
}

TEST_CASE("normal numbers have mean 0, variance 1, fourth moment 3") {
  Random random(11);
  constexpr int kDraws = 200000;
  double moments[5] = {};
  for (int i = 0; i < kDraws; ++i) {
    const double x = random.normal();
    double power = 1.0;
    for (double& moment : moments) {
      moment += power / kDraws;
      power *= x;
    }
  }
  CHECK(std::abs(moments[1]) < 5.0 / std::sqrt(kDraws));
  CHECK(moments[2] == Approx(1.0).margin(5.0 * std::sqrt(2.0 / kDraws)));
  CHECK(std::abs(moments[3]) < 5.0 * std::sqrt(15.0 / kDraws));
  CHECK(moments[4] == Approx(3.0).margin(5.0 * std::sqrt(96.0 / kDraws)));
}

}  // namespace shatterbox::core
