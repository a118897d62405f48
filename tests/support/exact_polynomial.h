// Polynomials of one variable with whole-number coefficients of any size, their real roots by Sturm's
// theorem, and signs of other polynomials there: nothing is rounded. For oracles, not for speed.
#pragma once

#include <gmpxx.h>

#include <vector>

namespace shatterbox::test {

/// numerator / 2^power.
struct Dyadic {
  mpz_class numerator = 0;
  unsigned power = 0;
};

/// The exact value of a double >= 0.
Dyadic dyadic_of(double value);

class Polynomial {
 public:
  Polynomial() = default;
  explicit Polynomial(std::vector<mpz_class> coefficients);  // from the constant term upwards

  int degree() const { return static_cast<int>(coefficients_.size()) - 1; }  // -1: zero everywhere
  bool is_zero() const { return coefficients_.empty(); }
  const std::vector<mpz_class>& coefficients() const { return coefficients_; }
  /// -1, 0 or 1.
  int sign_at(const Dyadic& x) const;
  Polynomial derivative() const;
  /// Divided by the (positive) greatest common divisor of its coefficients.
  Polynomial primitive() const;

  friend Polynomial operator+(const Polynomial& a, const Polynomial& b);
  friend Polynomial operator-(const Polynomial& a, const Polynomial& b);
  friend Polynomial operator*(const Polynomial& a, const Polynomial& b);

 private:
  std::vector<mpz_class> coefficients_;  // the last one is not zero
};

Polynomial greatest_common_divisor(const Polynomial& a, const Polynomial& b);

/// A real root: the only one of `square_free` in (low, high], or low itself if `is_low`.
struct Root {
  Polynomial square_free;
  Dyadic low, high;
  bool is_low = false;
};

/// The different roots in [0, 1], ascending. The polynomial must not be zero.
std::vector<Root> roots_in_unit_interval(const Polynomial& polynomial);

/// The sign of `polynomial` at the root. Narrows the root's interval.
int sign_at_root(const Polynomial& polynomial, Root& root);

/// True if the root is less than x.
bool is_before(const Root& root, const Dyadic& x);

}  // namespace shatterbox::test
