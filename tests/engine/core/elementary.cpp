// Against the platform's long double functions, with the errors that the header promises.
#include "engine/core/elementary.h"

#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <limits>

#include "engine/core/hash.h"
#include "engine/core/random.h"

namespace shatterbox::core {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

/// Greatest error of `value` against `truth`, in units of epsilon times the truth's size (but not below
/// `floor`).
struct Worst {
  double error = 0.0;
  double at = 0.0;
  void see(double x, double value, long double truth, double floor) {
    const double size = std::max(static_cast<double>(std::abs(truth)), floor);
    const double here =
        static_cast<double>(std::abs(static_cast<long double>(value) - truth)) / (size * kEpsilon);
    if (here > error) {
      error = here;
      at = x;
    }
  }
};

}  // namespace

TEST_CASE("sine and cosine keep an absolute error of a few 1e-16, up to a million radians") {
  Random random(1);
  Worst sine;
  Worst cosine;
  for (int i = 0; i < 200000; ++i) {
    const double range = i % 4 == 0 ? 1e6 : i % 4 == 1 ? 100.0 : 3.2;
    const double x = random.uniform(-range, range);
    sine.see(x, sin(x), std::sin(static_cast<long double>(x)), 1.0);
    cosine.see(x, cos(x), std::cos(static_cast<long double>(x)), 1.0);
  }
  INFO("at " << sine.at << " and " << cosine.at);
  CHECK(sine.error < 2.0);
  CHECK(cosine.error < 2.0);
  CHECK(sin(0.0) == 0.0);
  CHECK(cos(0.0) == 1.0);
  CHECK(sin(1e-200) == 1e-200);
  for (int k = -1000; k <= 1000; ++k) CHECK(std::abs(sin(k * kPi)) < 1e-12);
}

TEST_CASE("small sines are exact relative to their size, alone and with their cosines") {
  Random random(2);
  Worst worst, cosine;
  for (int i = 0; i < 50000; ++i) {
    const double x = random.uniform(-0.78, 0.78) * pow(10.0, -random.uniform(0.0, 20.0));
    worst.see(x, sin(x), std::sin(static_cast<long double>(x)), 0.0);
    worst.see(x, sin_cos(x).sin, std::sin(static_cast<long double>(x)), 0.0);
    cosine.see(x, sin_cos(x).cos, std::cos(static_cast<long double>(x)), 0.0);
  }
  CHECK(worst.error < 2.0);
  CHECK(cosine.error < 2.0);
}

TEST_CASE("the exponential and the logarithm keep a few units of the last place") {
  Random random(3);
  Worst exponential;
  Worst logarithm;
  for (int i = 0; i < 100000; ++i) {
    const double x = i % 2 == 0 ? random.uniform(-700.0, 709.0) : random.uniform(-1.0, 1.0);
    exponential.see(x, exp(x), std::exp(static_cast<long double>(x)), 0.0);
    const double y = i % 2 == 0 ? exp(random.uniform(-690.0, 690.0)) : random.uniform(0.5, 2.0);
    logarithm.see(y, log(y), std::log(static_cast<long double>(y)), 0.0);
  }
  INFO("at " << exponential.at << " and " << logarithm.at);
  CHECK(exponential.error < 3.0);
  CHECK(logarithm.error < 4.0);
  CHECK(exp(0.0) == 1.0);
  CHECK(log(1.0) == 0.0);
  CHECK(exp(-1000.0) == 0.0);
  CHECK(exp(1000.0) == std::numeric_limits<double>::max());
  CHECK(std::isfinite(log(std::numeric_limits<double>::denorm_min())));
  CHECK(log(std::numeric_limits<double>::max()) == Approx(709.782712893384).epsilon(1e-15));
}

TEST_CASE("powers") {
  Random random(4);
  for (int i = 0; i < 50000; ++i) {
    const double base = random.uniform(1e-3, 1e3);
    const double exponent = random.uniform(-8.0, 8.0);
    const long double truth = std::pow(static_cast<long double>(base), static_cast<long double>(exponent));
    // log's error is multiplied by what goes into exp, at most 8 * 7.
    REQUIRE(static_cast<double>(std::abs(pow(base, exponent) - truth) / truth) < 64.0 * 4.0 * kEpsilon);
  }
  CHECK(pow(0.0, 0.0) == 1.0);
  CHECK(pow(0.0, 3.0) == 0.0);
  CHECK(pow(5.0, 0.0) == 1.0);
}

TEST_CASE("angles") {
  Random random(5);
  Worst tangent;
  Worst cosine;
  Worst sine;
  for (int i = 0; i < 100000; ++i) {
    const double scale = exp(random.uniform(-100.0, 100.0));
    const double x = random.uniform(-1.0, 1.0) * scale;
    const double y = random.uniform(-1.0, 1.0) * scale * (i % 3 == 0 ? 1e-9 : 1.0);
    tangent.see(x, atan2(y, x), std::atan2(static_cast<long double>(y), static_cast<long double>(x)), 0.0);
    const double c = random.uniform(-1.0, 1.0);
    cosine.see(c, acos(c), std::acos(static_cast<long double>(c)), 0.0);
    sine.see(c, asin(c), std::asin(static_cast<long double>(c)), 1.0);
  }
  INFO("at " << tangent.at << ", " << cosine.at << ", " << sine.at);
  CHECK(tangent.error < 6.0);
  CHECK(cosine.error < 8.0);
  CHECK(sine.error < 4.0);
  CHECK(atan2(0.0, 0.0) == 0.0);
  CHECK(atan2(0.0, -1.0) == kPi);
  CHECK(atan2(1.0, 0.0) == 0.5 * kPi);
  CHECK(atan2(-1.0, 0.0) == -0.5 * kPi);
  CHECK(acos(1.0) == 0.0);
  CHECK(acos(-1.0) == kPi);
  CHECK(acos(1.0 + 1e-9) == 0.0);
  CHECK(acos(-2.0) == kPi);
}

TEST_CASE("the bits are the same on every machine") {
  Hash hash;
  Random random(6);
  for (int i = 0; i < 20000; ++i) {
    const double x = random.uniform(-50.0, 50.0);
    const double y = random.uniform(1e-6, 50.0);
    hash.add(sin(x))
        .add(cos(x))
        .add(exp(x))
        .add(log(y))
        .add(pow(y, 0.37))
        .add(atan2(x, y))
        .add(acos(x / 50.0));
    hash.add(sqrt(y)).add(random.normal());
  }
  CHECK(hash.value() == 0x7245a970869ef13aULL);
}

}  // namespace shatterbox::core
