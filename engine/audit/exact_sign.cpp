#include "engine/audit/exact_sign.h"

#include <cmath>
#include <vector>

namespace shatterbox::audit {
namespace {

/// A number as a sum of doubles that do not overlap, the least first; empty is zero.
using Expansion = std::vector<double>;

void two_sum(double a, double b, double& sum, double& rest) {
  sum = a + b;
  const double b_part = sum - a;
  const double a_part = sum - b_part;
  rest = (a - a_part) + (b - b_part);
}

void split(double a, double& high, double& low) {
  const double big = 134217729.0 * a;  // 2^27 + 1
  high = big - (big - a);
  low = a - high;
}

void two_product(double a, double b, double& product, double& rest) {
  product = a * b;
  double a_high, a_low, b_high, b_low;
  split(a, a_high, a_low);
  split(b, b_high, b_low);
  rest = a_low * b_low - (((product - a_high * b_high) - a_low * b_high) - a_high * b_low);
}

void add_to(Expansion& sum, double number) {
  Expansion result;
  for (const double part : sum) {
    double rest;
    two_sum(number, part, number, rest);
    if (rest != 0.0) result.push_back(rest);
  }
  if (number != 0.0) result.push_back(number);
  sum = std::move(result);
}

Expansion operator+(Expansion a, const Expansion& b) {
  for (const double part : b) add_to(a, part);
  return a;
}

Expansion operator-(Expansion a, const Expansion& b) {
  for (const double part : b) add_to(a, -part);
  return a;
}

Expansion operator*(const Expansion& a, const Expansion& b) {
  Expansion result;
  for (const double x : a) {
    for (const double y : b) {
      double product, rest;
      two_product(x, y, product, rest);
      add_to(result, rest);
      add_to(result, product);
    }
  }
  return result;
}

Expansion difference(double a, double b) {
  Expansion result;
  add_to(result, a);
  add_to(result, -b);
  return result;
}

int sign_of(const Expansion& number) {
  if (number.empty()) return 0;
  return number.back() > 0.0 ? 1 : -1;
}

int exact_volume_sign(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  Expansion p[3], q[3], r[3];
  for (int k = 0; k < 3; ++k) {
    p[k] = difference(a[k], d[k]);
    q[k] = difference(b[k], d[k]);
    r[k] = difference(c[k], d[k]);
  }
  return sign_of(p[0] * (q[1] * r[2] - q[2] * r[1]) + p[1] * (q[2] * r[0] - q[0] * r[2]) +
                 p[2] * (q[0] * r[1] - q[1] * r[0]));
}

}  // namespace

int volume_sign(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 p = a - d, q = b - d, r = c - d;
  const double yz = q.y() * r.z(), zy = q.z() * r.y();
  const double zx = q.z() * r.x(), xz = q.x() * r.z();
  const double xy = q.x() * r.y(), yx = q.y() * r.x();
  const double volume = p.x() * (yz - zy) + p.y() * (zx - xz) + p.z() * (xy - yx);
  const double size = std::abs(p.x()) * (std::abs(yz) + std::abs(zy)) +
                      std::abs(p.y()) * (std::abs(zx) + std::abs(xz)) +
                      std::abs(p.z()) * (std::abs(xy) + std::abs(yx));
  const double bound = 16.0 * kUnit * size;  // Shewchuk's is 7 + 56 units
  if (volume > bound) return 1;
  if (volume < -bound) return -1;
  return exact_volume_sign(a, b, c, d);
}

int area_sign(const Vec2& a, const Vec2& b, const Vec2& c) {
  const double left = (a.x() - c.x()) * (b.y() - c.y()), right = (a.y() - c.y()) * (b.x() - c.x());
  const double area = left - right;
  const double bound = 8.0 * kUnit * (std::abs(left) + std::abs(right));
  if (area > bound) return 1;
  if (area < -bound) return -1;
  return sign_of(difference(a.x(), c.x()) * difference(b.y(), c.y()) -
                 difference(a.y(), c.y()) * difference(b.x(), c.x()));
}

}  // namespace shatterbox::audit
