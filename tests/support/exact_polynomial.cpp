#include "tests/support/exact_polynomial.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace shatterbox::test {
namespace {

using Numbers = std::vector<mpz_class>;

int compare(const Dyadic& a, const Dyadic& b) {
  const unsigned power = std::max(a.power, b.power);
  return cmp(mpz_class(a.numerator << (power - a.power)), mpz_class(b.numerator << (power - b.power)));
}

Dyadic middle(const Dyadic& a, const Dyadic& b) {
  const unsigned power = std::max(a.power, b.power);
  return {mpz_class(a.numerator << (power - a.power)) + mpz_class(b.numerator << (power - b.power)),
          power + 1};
}

/// A positive multiple of the remainder of a by b.
Polynomial remainder(const Polynomial& a, const Polynomial& b) {
  Numbers rest = a.coefficients();
  const Numbers& divisor = b.coefficients();
  const mpz_class& lead = divisor.back();
  while (rest.size() >= divisor.size()) {
    const mpz_class top = rest.back() * sgn(lead);
    const std::size_t shift = rest.size() - divisor.size();
    for (mpz_class& c : rest) c *= abs(lead);
    for (std::size_t i = 0; i < divisor.size(); ++i) rest[i + shift] -= top * divisor[i];
    while (!rest.empty() && rest.back() == 0) rest.pop_back();
  }
  return Polynomial(rest).primitive();
}

std::vector<Polynomial> sturm_chain(const Polynomial& p) {
  std::vector<Polynomial> chain{p, p.derivative()};
  while (!chain.back().is_zero() && chain.back().degree() > 0) {
    Polynomial next = Polynomial() - remainder(chain[chain.size() - 2], chain.back());
    if (next.is_zero()) break;
    chain.push_back(std::move(next));
  }
  if (chain.back().is_zero()) chain.pop_back();
  return chain;
}

int sign_changes(const std::vector<Polynomial>& chain, const Dyadic& x) {
  int changes = 0, last = 0;
  for (const Polynomial& p : chain) {
    const int sign = p.sign_at(x);
    if (sign != 0 && last != 0 && sign != last) ++changes;
    if (sign != 0) last = sign;
  }
  return changes;
}

/// Number of different roots in (low, high].
int count_roots(const std::vector<Polynomial>& chain, const Dyadic& low, const Dyadic& high) {
  return sign_changes(chain, low) - sign_changes(chain, high);
}

/// a / b without remainder, up to a positive factor.
Polynomial exact_quotient(const Polynomial& a, const Polynomial& b) {
  Numbers rest = a.coefficients();
  const Numbers& divisor = b.coefficients();
  if (rest.size() < divisor.size()) return {};
  Numbers quotient(rest.size() - divisor.size() + 1);
  const mpz_class scale = abs(divisor.back());
  for (std::size_t k = quotient.size(); k-- > 0;) {
    for (mpz_class& c : rest) c *= scale;
    for (mpz_class& c : quotient) c *= scale;
    const mpz_class factor = rest[k + divisor.size() - 1] / divisor.back();
    quotient[k] = factor;
    for (std::size_t i = 0; i < divisor.size(); ++i) rest[i + k] -= factor * divisor[i];
  }
  return Polynomial(quotient).primitive();
}

void isolate(const std::vector<Polynomial>& chain, const Dyadic& low, const Dyadic& high,
             std::vector<Root>& roots) {
  const int count = count_roots(chain, low, high);
  if (count == 0) return;
  if (count == 1) {
    roots.push_back({chain.front(), low, high, false});
    return;
  }
  const Dyadic half = middle(low, high);
  isolate(chain, low, half, roots);
  isolate(chain, half, high, roots);
}

/// Halves the root's interval.
void narrow(Root& root) {
  if (root.is_low) return;
  const Dyadic half = middle(root.low, root.high);
  const int sign_half = root.square_free.sign_at(half);
  if (sign_half == 0) {
    root.low = root.high = half;
    root.is_low = true;
    return;
  }
  // One simple root in (low, high]: the sign at high is 0 or that beyond the root.
  const int sign_high = root.square_free.sign_at(root.high);
  if (sign_high == 0) {
    root.low = root.high;
    root.is_low = true;
  } else if (sign_high == sign_half) {
    root.high = half;
  } else {
    root.low = half;
  }
}

/// The common sign on [low, high] if the coefficients in Bernstein's form on it have one; else 0.
int sign_on(const Polynomial& p, const Dyadic& low, const Dyadic& high) {
  const unsigned power = std::max(low.power, high.power);
  const mpz_class from = low.numerator << (power - low.power);
  const mpz_class width = mpz_class(high.numerator << (power - high.power)) - from;
  // p((from + width s) / 2^power) times 2^(power degree), in powers of s by Horner's scheme.
  Polynomial shifted;
  const Polynomial step(Numbers{from, width});
  mpz_class scale = 1;
  for (std::size_t i = p.coefficients().size(); i-- > 0;) {
    shifted = shifted * step + Polynomial(Numbers{mpz_class(p.coefficients()[i] * scale)});
    scale <<= power;
  }
  const std::size_t n = p.coefficients().size();
  int common = 2;
  for (std::size_t i = 0; i < n; ++i) {
    mpz_class sum = 0;  // binomial(n - 1 - j, i - j) are those of a common factor times Bernstein's
    for (std::size_t j = 0; j <= i && j < shifted.coefficients().size(); ++j) {
      mpz_class binomial;
      mpz_bin_uiui(binomial.get_mpz_t(), n - 1 - j, i - j);
      sum += binomial * shifted.coefficients()[j];
    }
    if (common == 2) common = sgn(sum);
    if (sgn(sum) == 0 || sgn(sum) != common) return 0;
  }
  return common == 2 ? 0 : common;
}

}  // namespace

Dyadic dyadic_of(double value) {
  int exponent = 0;
  const double mantissa = std::ldexp(std::frexp(value, &exponent), 53);
  exponent -= 53;
  mpz_class number(mantissa);
  if (exponent >= 0) return {mpz_class(number << static_cast<unsigned>(exponent)), 0};
  return {number, static_cast<unsigned>(-exponent)};
}

Polynomial::Polynomial(Numbers coefficients) : coefficients_(std::move(coefficients)) {
  while (!coefficients_.empty() && coefficients_.back() == 0) coefficients_.pop_back();
}

int Polynomial::sign_at(const Dyadic& x) const {
  mpz_class sum = 0, scale = 1;
  for (std::size_t i = coefficients_.size(); i-- > 0;) {
    sum = sum * x.numerator + coefficients_[i] * scale;
    scale <<= x.power;
  }
  return sgn(sum);
}

Polynomial Polynomial::derivative() const {
  Numbers result;
  for (std::size_t i = 1; i < coefficients_.size(); ++i)
    result.push_back(coefficients_[i] * static_cast<unsigned long>(i));
  return Polynomial(result);
}

Polynomial Polynomial::primitive() const {
  mpz_class divisor = 0;
  for (const mpz_class& c : coefficients_) divisor = gcd(divisor, c);
  Polynomial result = *this;
  if (divisor > 1)
    for (mpz_class& c : result.coefficients_) c /= divisor;
  return result;
}

Polynomial operator+(const Polynomial& a, const Polynomial& b) {
  Numbers sum(std::max(a.coefficients_.size(), b.coefficients_.size()));
  for (std::size_t i = 0; i < a.coefficients_.size(); ++i) sum[i] += a.coefficients_[i];
  for (std::size_t i = 0; i < b.coefficients_.size(); ++i) sum[i] += b.coefficients_[i];
  return Polynomial(std::move(sum));
}

Polynomial operator-(const Polynomial& a, const Polynomial& b) {
  Numbers sum(std::max(a.coefficients_.size(), b.coefficients_.size()));
  for (std::size_t i = 0; i < a.coefficients_.size(); ++i) sum[i] += a.coefficients_[i];
  for (std::size_t i = 0; i < b.coefficients_.size(); ++i) sum[i] -= b.coefficients_[i];
  return Polynomial(std::move(sum));
}

Polynomial operator*(const Polynomial& a, const Polynomial& b) {
  if (a.is_zero() || b.is_zero()) return {};
  Numbers product(a.coefficients_.size() + b.coefficients_.size() - 1);
  for (std::size_t i = 0; i < a.coefficients_.size(); ++i)
    for (std::size_t j = 0; j < b.coefficients_.size(); ++j)
      product[i + j] += a.coefficients_[i] * b.coefficients_[j];
  return Polynomial(std::move(product));
}

Polynomial greatest_common_divisor(const Polynomial& a, const Polynomial& b) {
  Polynomial p = a.primitive(), q = b.primitive();
  while (!q.is_zero()) {
    Polynomial rest = p.degree() < q.degree() ? p : remainder(p, q);
    p = std::move(q);
    q = std::move(rest);
  }
  return p;
}

std::vector<Root> roots_in_unit_interval(const Polynomial& polynomial) {
  const Dyadic zero{0, 0}, one{1, 0};
  std::vector<Root> roots;
  if (polynomial.degree() <= 0 || sign_on(polynomial, zero, one) != 0) return roots;
  const Polynomial square_free =
      exact_quotient(polynomial, greatest_common_divisor(polynomial, polynomial.derivative()));
  if (square_free.sign_at(zero) == 0) roots.push_back({square_free, zero, zero, true});
  isolate(sturm_chain(square_free), zero, one, roots);
  return roots;
}

int sign_at_root(const Polynomial& polynomial, Root& root) {
  if (polynomial.is_zero()) return 0;
  if (root.is_low) return polynomial.sign_at(root.low);
  for (int i = 0; i < 12; ++i) {
    if (const int sign = sign_on(polynomial, root.low, root.high); sign != 0) return sign;
    narrow(root);
    if (root.is_low) return polynomial.sign_at(root.low);
  }
  const Polynomial common = greatest_common_divisor(polynomial, root.square_free);
  if (common.degree() > 0 && count_roots(sturm_chain(common), root.low, root.high) > 0) return 0;
  for (;;) {
    if (const int sign = sign_on(polynomial, root.low, root.high); sign != 0) return sign;
    narrow(root);
    if (root.is_low) return polynomial.sign_at(root.low);
  }
}

bool is_before(const Root& root, const Dyadic& x) {
  if (root.is_low) return compare(root.low, x) < 0;
  if (compare(root.low, x) >= 0) return false;
  if (compare(root.high, x) < 0) return true;
  if (root.square_free.sign_at(x) == 0) return false;  // low < x <= high: the root is x
  return count_roots(sturm_chain(root.square_free), root.low, x) > 0;
}

}  // namespace shatterbox::test
