// One crack through a solid: a surface that is the zero of a field, linear in each element, grown from where
// it starts over the faces that it crosses, across the first principal stress. It knows the values at the
// nodes of the elements it has reached, and nothing is cut while it grows.
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "engine/fracture/path_noise.h"
#include "engine/geometry/solid_cutter.h"
#include "engine/stress/solid_stress.h"

namespace shatterbox::fracture {

/// Elements about each node of a mesh, ascending.
class NodeElements {
 public:
  explicit NodeElements(const geometry::TetMesh& mesh);
  const int* begin(int node) const { return elements_.data() + first_[static_cast<std::size_t>(node)]; }
  const int* end(int node) const { return elements_.data() + first_[static_cast<std::size_t>(node) + 1]; }

 private:
  std::vector<int> first_, elements_;
};

/// Where a crack's field is zero in one cell.
struct CrackCap {
  double area = 0.0;           // m2; 0: the field has one sign there
  Vec3 middle = Vec3::Zero();  // m, of its corners
};

/// The values of a crack's field at the nodes that it has reached; made once, used for one crack after the
/// other.
class CrackField {
 public:
  CrackField(const geometry::SolidComplex& complex, const NodeElements& around);

  /// Forgets all values; then the plane through `place` across `normal` (unit), at the nodes of an element.
  void start(int element, const Vec3& place, const Vec3& normal);

  /// The values of an earlier crack.
  using Values = std::vector<std::pair<int, double>>;  // by node
  void restore(const Values& values);
  const Values& known() const { return known_; }

  /// What a crack that comes into an element would do: the normal (unit) it would like to have there, from
  /// the one it has.
  using Wish = std::function<Vec3(int element, const Vec3& normal)>;

  /// Gives the fourth node of an element whose other three have values one: the mean over all elements about
  /// the node of which the field crosses the opposite face, each of which proposes the gradient nearest to
  /// its wish.
  void reach(int element, const Wish& wish);

  bool is_known(int node) const { return stamps_[static_cast<std::size_t>(node)] == stamp_; }
  bool has_all(int element) const;
  /// At an element all of whose nodes have values; not normalised.
  Vec3 gradient(int element) const;
  double value(const geometry::SolidVertex& vertex) const;
  /// Whether the field has both signs on a settled facet.
  bool crosses(const geometry::SolidFacet& facet) const;
  CrackCap cap(int cell) const;  // settled
  const std::vector<double>& values() const { return values_; }

 private:
  void set(int node, double value, double least);
  int unknown_corner(int element) const;

  const geometry::SolidComplex& complex_;
  const NodeElements& around_;
  std::vector<double> values_;  // |nodes|
  std::vector<int> stamps_;
  Values known_;
  int stamp_ = 0;
};

}  // namespace shatterbox::fracture
