#include "engine/fracture/solid_crack.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "engine/core/elementary.h"
#include "engine/core/index.h"

namespace shatterbox::fracture {
namespace {

using Size = std::size_t;
using core::at;

constexpr double kOffNodes = 0.05;     // least distance of a crack from a node, share of the element's size
constexpr double kSteepestTurn = 2.5;  // greatest part of a gradient across a face, of its part along it

std::array<Vec3, 4> corners_of(const geometry::TetMesh& mesh, int element) {
  std::array<Vec3, 4> corners;
  for (Size i = 0; i < 4; ++i) corners[i] = mesh.positions[at(mesh.tetrahedra[at(element)][i])];
  return corners;
}

/// Mean length of an element's edges, m.
double element_size(const std::array<Vec3, 4>& x) {
  double sum = 0.0;
  for (const auto& edge : geometry::kTetrahedronEdges) sum += (x[at(edge[0])] - x[at(edge[1])]).norm();
  return sum / 6.0;
}

}  // namespace

NodeElements::NodeElements(const geometry::TetMesh& mesh) : first_(mesh.positions.size() + 1, 0) {
  for (const geometry::Tetrahedron& t : mesh.tetrahedra)
    for (const int v : t) ++first_[at(v) + 1];
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  elements_.resize(4 * mesh.tetrahedra.size());
  std::vector<int> next(first_.begin(), first_.end() - 1);
  for (Size e = 0; e < mesh.tetrahedra.size(); ++e)
    for (const int v : mesh.tetrahedra[e]) elements_[at(next[at(v)]++)] = static_cast<int>(e);
}

CrackField::CrackField(const geometry::SolidComplex& complex, const NodeElements& around)
    : complex_(complex),
      around_(around),
      values_(complex.elements->mesh.positions.size(), 0.0),
      stamps_(values_.size(), 0) {}

/// A value, at least `least` away from zero; zero is on the positive side.
void CrackField::set(int node, double value, double least) {
  values_[at(node)] = value >= 0.0 ? std::max(value, least) : std::min(value, -least);
  stamps_[at(node)] = stamp_;
  known_.emplace_back(node, values_[at(node)]);
}

void CrackField::restore(const Values& values) {
  ++stamp_;
  known_ = values;
  for (const auto& [node, value] : values) {
    values_[at(node)] = value;
    stamps_[at(node)] = stamp_;
  }
}

void CrackField::start(int element, const Vec3& place, const Vec3& normal) {
  ++stamp_;
  known_.clear();
  const geometry::TetMesh& mesh = complex_.elements->mesh;
  const double least = kOffNodes * element_size(corners_of(mesh, element));
  for (const int node : mesh.tetrahedra[at(element)])
    set(node, normal.dot(mesh.positions[at(node)] - place), least);
}

bool CrackField::has_all(int element) const {
  const geometry::Tetrahedron& t = complex_.elements->mesh.tetrahedra[at(element)];
  return std::all_of(t.begin(), t.end(), [&](int node) { return is_known(node); });
}

/// The only corner without a value; -1 if there is none or are several.
int CrackField::unknown_corner(int element) const {
  const geometry::Tetrahedron& t = complex_.elements->mesh.tetrahedra[at(element)];
  int found = -1;
  for (int i = 0; i < 4; ++i) {
    if (is_known(t[at(i)])) continue;
    if (found >= 0) return -1;
    found = i;
  }
  return found;
}

Vec3 CrackField::gradient(int element) const {
  const geometry::Tetrahedron& t = complex_.elements->mesh.tetrahedra[at(element)];
  const std::array<Vec3, 4> x = corners_of(complex_.elements->mesh, element);
  const Vec3 b = x[1] - x[0], c = x[2] - x[0], d = x[3] - x[0];
  const double six_volumes = b.cross(c).dot(d);
  if (!(six_volumes > 0.0)) return Vec3::Zero();
  const double f = values_[at(t[0])];
  return ((values_[at(t[1])] - f) * c.cross(d) + (values_[at(t[2])] - f) * d.cross(b) +
          (values_[at(t[3])] - f) * b.cross(c)) /
         six_volumes;
}

void CrackField::reach(int element, const Wish& wish) {
  const geometry::SolidElements& elements = *complex_.elements;
  const int corner = unknown_corner(element);
  if (corner < 0) return;
  const int node = elements.mesh.tetrahedra[at(element)][at(corner)];
  double sum = 0.0, steepness = 0.0;
  int count = 0;
  for (const int* e = around_.begin(node); e != around_.end(node); ++e) {
    const int own = unknown_corner(*e);
    if (own < 0) continue;
    const geometry::Tetrahedron& t = elements.mesh.tetrahedra[at(*e)];
    const auto& face = geometry::kTetrahedronFaces[at(own)];
    const std::array<int, 3> v{t[at(face[0])], t[at(face[1])], t[at(face[2])]};
    const int plus =
        static_cast<int>(std::count_if(v.begin(), v.end(), [&](int i) { return values_[at(i)] > 0.0; }));
    if (plus == 0 || plus == 3) continue;
    const Vec3& a = elements.mesh.positions[at(v[0])];
    const Vec3 ab = elements.mesh.positions[at(v[1])] - a, ac = elements.mesh.positions[at(v[2])] - a;
    const Vec3 area = ab.cross(ac);
    const double area_squared = area.squaredNorm();
    if (!(area_squared > 0.0)) continue;
    const Vec3 along = ((values_[at(v[1])] - values_[at(v[0])]) * ac.cross(area) +
                        (values_[at(v[2])] - values_[at(v[0])]) * area.cross(ab)) /
                       area_squared;
    const Vec3 across = -area / core::sqrt(area_squared);  // towards the node
    const double steep = along.norm();
    if (!(steep > 0.0)) continue;
    // The normal that the crack has on the face's other side, if it came from there.
    Vec3 present = along / steep;
    const auto& sides =
        elements.topology.face_tetrahedra[at(elements.topology.tetrahedron_faces[at(*e)][at(own)])];
    const int other = sides[0] == *e ? sides[1] : sides[0];
    if (other >= 0 && has_all(other))
      if (const Vec3 g = gradient(other); g.squaredNorm() > 0.0) present = g.normalized();
    const Vec3 wanted = wish(*e, present);
    // The multiple of `across` that makes the gradient as parallel to the wish as it can be.
    const double part_along = wanted.dot(along) / steep, part_across = wanted.dot(across);
    const double most = kSteepestTurn * steep;
    double turn = part_across >= 0.0 ? most : -most;
    if (part_along > 0.0) turn = std::clamp(steep * part_across / part_along, -most, most);
    sum += values_[at(v[0])] + (along + turn * across).dot(elements.mesh.positions[at(node)] - a);
    steepness += core::sqrt(steep * steep + turn * turn);
    ++count;
  }
  if (count == 0) return;
  const double size = element_size(corners_of(elements.mesh, element));
  set(node, sum / count, kOffNodes * size * steepness / count);
}

double CrackField::value(const geometry::SolidVertex& vertex) const {
  double sum = 0.0;
  for (Size k = 0; k < 4 && vertex.nodes[k] >= 0; ++k)
    sum += vertex.weights[k] * values_[at(vertex.nodes[k])];
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
