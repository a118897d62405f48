#include "engine/core/elementary.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace shatterbox::core {
namespace {

// pi/2 in three parts; k * part is exact for |k| < 2^20 in the first two.
constexpr double kHalfPi1 = 0x1.921fb544p+0;
constexpr double kHalfPi2 = 0x1.0b4611a6p-34;
constexpr double kHalfPi3 = 0x1.3198a2e037073p-69;

// Taylor sums on |x| <= pi/4: the first term left out is below 1e-19.
double sin_near_zero(double x) {
  const double z = x * x;
  double s = -1.0 / 121645100408832000.0;
  s = s * z + 1.0 / 355687428096000.0;
  s = s * z - 1.0 / 1307674368000.0;
  s = s * z + 1.0 / 6227020800.0;
  s = s * z - 1.0 / 39916800.0;
  s = s * z + 1.0 / 362880.0;
  s = s * z - 1.0 / 5040.0;
  s = s * z + 1.0 / 120.0;
  s = s * z - 1.0 / 6.0;
  return x + x * z * s;
}

double cos_near_zero(double x) {
  const double z = x * x;
  double s = -1.0 / 6402373705728000.0;
  s = s * z + 1.0 / 20922789888000.0;
  s = s * z - 1.0 / 87178291200.0;
  s = s * z + 1.0 / 479001600.0;
  s = s * z - 1.0 / 3628800.0;
  s = s * z + 1.0 / 40320.0;
  s = s * z - 1.0 / 720.0;
  s = s * z + 1.0 / 24.0;
  return 1.0 - (0.5 * z - z * z * s);
}

struct Reduced {
  double rest;
  int quadrant;
};

Reduced reduce(double x) {
  const double turns = x * (2.0 / kPi);
  const double k = std::trunc(turns + (turns < 0.0 ? -0.5 : 0.5));
  const double rest = ((x - k * kHalfPi1) - k * kHalfPi2) - k * kHalfPi3;
  return {rest, static_cast<int>(static_cast<std::int64_t>(k) & 3)};
}

double scale_by_power_of_two(double x, int power) {
  return x * std::bit_cast<double>(static_cast<std::uint64_t>(power + 1023) << 52);
}

double atan_near_zero(double x) {  // |x| <= tan(pi/16)
  const double z = x * x;
  double s = 0.0;
  for (int n = 25; n >= 3; n -= 2) s = (s + (n % 4 == 1 ? 1.0 : -1.0) / n) * z;
  return x + x * s;
}

double atan_positive(double x) {  // 0 <= x <= 1: halve the angle twice
  const double half = x / (1.0 + sqrt(1.0 + x * x));
  const double quarter = half / (1.0 + sqrt(1.0 + half * half));
  return 4.0 * atan_near_zero(quarter);
}

}  // namespace

double sqrt(double x) {
  return std::sqrt(x);
}

double sin(double x) {
  const Reduced r = reduce(x);
  const double value = r.quadrant & 1 ? cos_near_zero(r.rest) : sin_near_zero(r.rest);
  return r.quadrant & 2 ? -value : value;
}

double cos(double x) {
  const Reduced r = reduce(x);
  const double value = r.quadrant & 1 ? sin_near_zero(r.rest) : cos_near_zero(r.rest);
  return r.quadrant == 1 || r.quadrant == 2 ? -value : value;
}

SinCos sin_cos(double x) {
  if (std::abs(x) > 0.03125) return {sin(x), cos(x)};
  // The first terms left out are below 2e-19 and 2e-21.
  const double z = x * x;
  const double s = -1.0 / 6.0 + z * (1.0 / 120.0 + z * (-1.0 / 5040.0 + z * (1.0 / 362880.0)));
  const double c = 1.0 / 24.0 + z * (-1.0 / 720.0 + z * (1.0 / 40320.0 - z * (1.0 / 3628800.0)));
  return {x + x * z * s, 1.0 - (0.5 * z - z * z * c)};
}

double exp(double x) {
  if (x < -708.0) return 0.0;
  if (x > 709.0) return std::numeric_limits<double>::max();
  constexpr double kLn2High = 0x1.62e42feep-1;
  constexpr double kLn2Low = 0x1.a39ef35793c76p-33;
  const double turns = x * 1.4426950408889634;
  const double k = std::trunc(turns + (turns < 0.0 ? -0.5 : 0.5));
  const double rest = (x - k * kLn2High) - k * kLn2Low;
  double s = 0.0;
  for (int n = 15; n >= 1; --n) s = (s + 1.0) * rest / n;
  const int power = static_cast<int>(k);
  const int first = power / 2;  // in two steps: 2^1024 is no double
  return scale_by_power_of_two(scale_by_power_of_two(1.0 + s, first), power - first);
}

double log(double x) {
  const double least = std::numeric_limits<double>::min();
  std::uint64_t bits = std::bit_cast<std::uint64_t>(x < least ? least : x);
  int power = static_cast<int>(bits >> 52) - 1023;
  double mantissa = std::bit_cast<double>((bits & 0x000fffffffffffffULL) | 0x3ff0000000000000ULL);
  if (mantissa > 1.4142135623730951) {
    mantissa *= 0.5;
    ++power;
  }
  const double q = (mantissa - 1.0) / (mantissa + 1.0);
  const double z = q * q;
  double s = 0.0;
  for (int n = 23; n >= 3; n -= 2) s = (s + 1.0 / n) * z;
  constexpr double kLn2High = 0x1.62e42feep-1;
  constexpr double kLn2Low = 0x1.a39ef35793c76p-33;
  return power * kLn2High + (power * kLn2Low + 2.0 * (q + q * s));
}

double pow(double base, double exponent) {
  if (exponent == 0.0) return 1.0;
  if (base <= 0.0) return 0.0;
  return exp(exponent * log(base));
}

double atan2(double y, double x) {
  const double ax = std::abs(x);
  const double ay = std::abs(y);
  if (ax == 0.0 && ay == 0.0) return 0.0;
  double angle = ay <= ax ? atan_positive(ay / ax) : 0.5 * kPi - atan_positive(ax / ay);
  if (x < 0.0) angle = kPi - angle;
  return y < 0.0 ? -angle : angle;
}

double acos(double x) {
  if (x >= 1.0) return 0.0;
  if (x <= -1.0) return kPi;
  return atan2(sqrt((1.0 - x) * (1.0 + x)), x);
}

double asin(double x) {
  return 0.5 * kPi - acos(x);
}

}  // namespace shatterbox::core
