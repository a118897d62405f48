#include "engine/geometry/expansion.h"

namespace shatterbox::geometry {
namespace {

struct Rounded {
  double value, error;  // the exact result is their sum
};

Rounded two_sum(double x, double y) {
  const double sum = x + y;
  const double y_taken = sum - x;
  const double x_taken = sum - y_taken;
  return {sum, (x - x_taken) + (y - y_taken)};
}

/// The two halves of a double, 26 bits each.
Rounded split(double x) {
  constexpr double kSplitter = 134217729.0;  // 2^27 + 1
  const double scaled = kSplitter * x;
  const double high = scaled - (scaled - x);
  return {high, x - high};
}

Rounded two_product(double x, double y) {
  const double product = x * y;
  const Rounded a = split(x);
  const Rounded b = split(y);
  const double left = ((a.value * b.value - product) + a.value * b.error) + a.error * b.value;
  return {product, left + a.error * b.error};
}

}  // namespace

Expansion::Expansion(double value) {
  add(value);
}

Expansion Expansion::difference(double x, double y) {
  const Rounded d = two_sum(x, -y);
  Expansion result(d.error);
  result.add(d.value);
  return result;
}

Expansion Expansion::product(double x, double y) {
  const Rounded p = two_product(x, y);
  Expansion result(p.error);
  result.add(p.value);
  return result;
}

/// [She97] Grow-Expansion, leaving out zeros.
void Expansion::add(double value) {
  std::size_t kept = 0;
  double carried = value;
  for (std::size_t i = 0; i < terms_.size(); ++i) {
    const Rounded s = two_sum(carried, terms_[i]);
    carried = s.value;
    if (s.error != 0.0) terms_[kept++] = s.error;
  }
  terms_.resize(kept);
  if (carried != 0.0) terms_.push_back(carried);
}

Expansion operator+(const Expansion& a, const Expansion& b) {
  Expansion result = a;
  for (const double term : b.terms_) result.add(term);
  return result;
}

Expansion operator-(const Expansion& a, const Expansion& b) {
  Expansion result = a;
  for (const double term : b.terms_) result.add(-term);
  return result;
}

Expansion operator*(const Expansion& a, const Expansion& b) {
  Expansion result;
  for (const double x : a.terms_)
    for (const double y : b.terms_) {
      const Rounded p = two_product(x, y);
      result.add(p.error);
      result.add(p.value);
    }
  return result;
}

int Expansion::sign() const {
  if (terms_.empty()) return 0;
  return terms_.back() > 0.0 ? 1 : -1;
}

double Expansion::estimate() const {
  double sum = 0.0;
  for (const double term : terms_) sum += term;
  return sum;
}

}  // namespace shatterbox::geometry
