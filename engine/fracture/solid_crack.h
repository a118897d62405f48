// One crack through a solid: a surface that is the zero of a field, linear in each element (crack_guide.h
// makes it). Nothing is cut while it grows.
#pragma once

#include <memory>
#include <vector>

#include "engine/geometry/solid_cutter.h"

namespace shatterbox::fracture {

/// Where a crack's field is zero in one cell.
struct CrackCap {
  double area = 0.0;           // m2; 0: the field has one sign there
  Vec3 middle = Vec3::Zero();  // m, of its corners
};

/// A field by node of the element mesh; 0 where nobody knows it. Shared by a crack's generations.
using CrackValues = std::shared_ptr<const std::vector<double>>;

/// Reads one crack's field after the other.
class CrackField {
 public:
  explicit CrackField(const geometry::SolidComplex& complex) : complex_(complex) {}

  void take(CrackValues values) { values_ = std::move(values); }
  const CrackValues& values() const { return values_; }

  bool has_all(int element) const;
  /// At an element all of whose nodes have values; not normalised.
  Vec3 gradient(int element) const;
  double value(const geometry::SolidVertex& vertex) const;
  /// Whether the field has both signs on a settled facet.
  bool crosses(const geometry::SolidFacet& facet) const;
  /// Whether all of a settled facet of an element is on the surface.
  bool holds(const geometry::SolidFacet& facet, int element) const;
  CrackCap cap(int cell) const;  // settled

 private:
  const geometry::SolidComplex& complex_;
  CrackValues values_;
};

}  // namespace shatterbox::fracture
