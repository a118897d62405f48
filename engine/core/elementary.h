// sin, cos, exp, log, pow, atan2, acos that give the same bits on every CPU and compiler, as libm's do not.
// Accurate to a few units in the last place over the ranges the engine uses
// (tests/engine/core/elementary.cpp).
#pragma once

namespace shatterbox::core {

inline constexpr double kPi = 3.14159265358979323846;

/// Square root, correctly rounded everywhere (IEEE 754). x >= 0.
double sqrt(double x);

/// Sine and cosine; |x| < 1e6 radians keeps an absolute error below 1e-15 (1 + |x| 1e-16).
double sin(double x);
double cos(double x);

/// Both at once; cheaper still for small angles.
struct SinCos {
  double sin, cos;
};
SinCos sin_cos(double x);

/// e^x. Below -708 the result is 0; above 709 it is the largest finite double.
double exp(double x);

/// Natural logarithm; x > 0 and finite (a denormal counts as the smallest normal number).
double log(double x);

/// base^exponent for base >= 0; 0^0 = 1, 0^positive = 0.
double pow(double base, double exponent);

/// Angle of (x, y) in (-pi, pi]; 0 for the origin.
double atan2(double y, double x);

/// Inverse cosine and sine; arguments are clamped to [-1, 1].
double acos(double x);
double asin(double x);

}  // namespace shatterbox::core
