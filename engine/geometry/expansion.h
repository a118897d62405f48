// Sums of doubles that do not overlap: whole numbers of arithmetic without rounding, for signs that must be
// right [She97]. Sums, differences and products of doubles are exact as long as nothing leaves the range of a
// double (sizes from 1e-40 to 1e60 m do not).
#pragma once

#include <vector>

namespace shatterbox::geometry {

class Expansion {
 public:
  Expansion() = default;
  explicit Expansion(double value);

  /// x - y and x y, exactly.
  static Expansion difference(double x, double y);
  static Expansion product(double x, double y);

  friend Expansion operator+(const Expansion& a, const Expansion& b);
  friend Expansion operator-(const Expansion& a, const Expansion& b);
  friend Expansion operator*(const Expansion& a, const Expansion& b);

  /// -1, 0 or 1.
  int sign() const;

  /// The nearest double, or a neighbour of it.
  double estimate() const;

 private:
  void add(double value);

  std::vector<double> terms_;  // not overlapping, ascending in size, none of them zero
};

}  // namespace shatterbox::geometry
