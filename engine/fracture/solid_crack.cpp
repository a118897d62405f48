#include "engine/fracture/solid_crack.h"

#include <algorithm>
#include <cmath>

#include "engine/core/index.h"

namespace shatterbox::fracture {

namespace {

using Size = std::size_t;
using core::at;

constexpr double kOnSurface = 1e-4;  // of the field's greatest value about: nearer is on the surface

}  // namespace

bool CrackField::has_all(int element) const {
  const geometry::Tetrahedron& t = complex_.elements->mesh.tetrahedra[at(element)];
  return std::all_of(t.begin(), t.end(), [&](int node) { return (*values_)[at(node)] != 0.0; });
}

Vec3 CrackField::gradient(int element) const {
  const geometry::Tetrahedron& t = complex_.elements->mesh.tetrahedra[at(element)];
  const std::vector<Vec3>& x = complex_.elements->mesh.positions;
  const Vec3& a = x[at(t[0])];
  const Vec3 b = x[at(t[1])] - a, c = x[at(t[2])] - a, d = x[at(t[3])] - a;
  const double six_volumes = b.cross(c).dot(d);
  if (!(six_volumes > 0.0)) return Vec3::Zero();
  const double f = (*values_)[at(t[0])];
  return (((*values_)[at(t[1])] - f) * c.cross(d) + ((*values_)[at(t[2])] - f) * d.cross(b) +
          ((*values_)[at(t[3])] - f) * b.cross(c)) /
         six_volumes;
}

double CrackField::value(const geometry::SolidVertex& vertex) const {
  double sum = 0.0;
  for (Size k = 0; k < 4 && vertex.nodes[k] >= 0; ++k)
    sum += vertex.weights[k] * (*values_)[at(vertex.nodes[k])];
  return sum;
}

bool CrackField::crosses(const geometry::SolidFacet& facet) const {
  bool has_plus = false, has_minus = false;
  for (int i = 0; i < facet.side_count; ++i) {
    const double v = value(complex_.vertices[at(complex_.side_begin(complex_.sides_of(facet)[i]))]);
    (v >= 0.0 ? has_plus : has_minus) = true;
  }
  return has_plus && has_minus;
}

bool CrackField::holds(const geometry::SolidFacet& facet, int element) const {
  double greatest = 0.0;
  for (const int node : complex_.elements->mesh.tetrahedra[at(element)])
    greatest = std::max(greatest, std::abs((*values_)[at(node)]));
  for (int i = 0; i < facet.side_count; ++i)
    if (!(std::abs(value(complex_.vertices[at(complex_.side_begin(complex_.sides_of(facet)[i]))])) <
          kOnSurface * greatest))
      return false;
  return true;
}

CrackCap CrackField::cap(int cell) const {
  const geometry::SolidPart& part = complex_.cells[at(cell)];
  CrackCap cap;
  Vec3 area = Vec3::Zero(), sum = Vec3::Zero(), origin = Vec3::Zero();
  int count = 0;
  for (int f = 0; f < part.facet_count; ++f) {
    const int facet_side = complex_.cell_facets[at(part.first_facet + f)];
    const geometry::SolidFacet& facet = complex_.facets[at(facet_side / 2)];
    // Where the border of the facet leaves the positive side, and where it comes back.
    Vec3 leaves = Vec3::Zero(), returns = Vec3::Zero();
    int changes = 0;
    for (int i = 0; i < facet.side_count; ++i) {
      const int side = complex_.sides_of(facet)[i];
      const geometry::SolidVertex& a = complex_.vertices[at(complex_.side_begin(side))];
      const geometry::SolidVertex& b = complex_.vertices[at(complex_.side_end(side))];
      const double va = value(a), vb = value(b);
      if ((va >= 0.0) == (vb >= 0.0)) continue;
      (va >= 0.0 ? leaves : returns) = a.position + va / (va - vb) * (b.position - a.position);
      ++changes;
    }
    if (changes != 2) continue;
    if (count == 0) origin = leaves;
    const double sign = facet_side % 2 == 0 ? 1.0 : -1.0;
    area += sign * (leaves - origin).cross(returns - origin);
    sum += leaves + returns;
    count += 2;
  }
  if (count == 0) return cap;
  cap.area = 0.5 * area.norm();
  cap.middle = sum / count;
  return cap;
}

}  // namespace shatterbox::fracture
