#include "engine/geometry/solid_deform.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "engine/core/index.h"

namespace shatterbox::geometry {
namespace {

using core::at;

bool is_leaf(const SolidFacet& facet) {
  return facet.parts[0] < 0 && (facet.cells[0] >= 0 || facet.cells[1] >= 0);
}

/// Kerfs go along with the element that their vertex is in.
void move_kerfs(const TetMesh& before, SolidComplex& complex) {
  const TetMesh& after = complex.elements->mesh;
  std::vector<char> is_moved(complex.vertices.size(), 0);
  for (const SolidFacet& facet : complex.facets) {
    if (!is_leaf(facet)) continue;
    for (int i = 0; i < facet.side_count; ++i) {
      const int v = complex.side_begin(complex.sides_of(facet)[i]);
      SolidVertex& vertex = complex.vertices[at(v)];
      if (!vertex.has_kerf || is_moved[at(v)] != 0) continue;
      is_moved[at(v)] = 1;
      const int element = complex.cells[at(std::max(facet.cells[0], facet.cells[1]))].element;
      vertex.kerf =
          (edge_matrix(after, element) * edge_matrix(before, element).inverse() * vertex.kerf).eval();
    }
  }
}

/// Divides what is left of given triangles into parts that are still flat.
class FlatParts {
 public:
  FlatParts(SolidComplex& complex, double flatness) : complex_(complex), flatness_(flatness) {}

  /// Tags the facets by parts; returns the given triangle of each part.
  std::vector<int> tag() {
    for (std::size_t f = 0; f < complex_.facets.size(); ++f) {
      const SolidFacet& facet = complex_.facets[f];
      if (!is_leaf(facet) || facet.kind != FacetKind::outer || facet.tag < 0) continue;
      outer_.push_back({static_cast<int>(f), facet.tag, facet_area_vector(complex_, facet)});
      for (int i = 0; i < facet.side_count; ++i)
        facets_at_[complex_.sides_of(facet)[i] / 2].push_back(static_cast<int>(outer_.size()) - 1);
    }
    std::vector<int> order(outer_.size());
    for (std::size_t k = 0; k < order.size(); ++k) order[k] = static_cast<int>(k);
    // The greatest facets tell best which way their part faces.
    std::stable_sort(order.begin(), order.end(), [this](int a, int b) {
      return outer_[at(a)].area.squaredNorm() > outer_[at(b)].area.squaredNorm();
    });
    for (const int seed : order)
      if (!outer_[at(seed)].is_taken) grow(seed);
    return std::move(sources_);
  }

 private:
  struct Outer {
    int facet, source;
    Vec3 area;
    bool is_taken = false;
  };

  bool is_in_plane(const SolidFacet& facet, const Vec3& point, const Vec3& normal) const {
    for (int i = 0; i < facet.side_count; ++i)
      if (std::abs(normal.dot(complex_.position(complex_.side_begin(complex_.sides_of(facet)[i])) - point)) >
          flatness_)
        return false;
    return true;
  }

  void grow(int seed) {
    const int source = outer_[at(seed)].source;
    const SolidFacet& first = complex_.facets[at(outer_[at(seed)].facet)];
    const Vec3 point = complex_.position(complex_.side_begin(complex_.sides_of(first)[0]));
    const double size = outer_[at(seed)].area.norm();
    const Vec3 normal = size > 0.0 ? Vec3(outer_[at(seed)].area / size) : Vec3(Vec3::Zero());
    const int tag = static_cast<int>(sources_.size());
    sources_.push_back(source);
    outer_[at(seed)].is_taken = true;
    std::vector<int> taken{seed};
    for (std::size_t k = 0; k < taken.size(); ++k) {
      SolidFacet& facet = complex_.facets[at(outer_[at(taken[k])].facet)];
      facet.tag = tag;
      for (int i = 0; i < facet.side_count; ++i)
        for (const int next : facets_at_[complex_.sides_of(facet)[i] / 2]) {
          Outer& other = outer_[at(next)];
          if (other.is_taken || other.source != source || !(other.area.dot(normal) >= 0.0) ||
              !is_in_plane(complex_.facets[at(other.facet)], point, normal))
            continue;
          other.is_taken = true;
          taken.push_back(next);
        }
    }
  }

  SolidComplex& complex_;
  double flatness_;
  std::vector<Outer> outer_;
  std::map<int, std::vector<int>> facets_at_;  // by edge
  std::vector<int> sources_;
};

/// 1 for an element without volume.
double element_volume_share(const SolidComplex& piece, int element, const std::vector<Vec3>& moves) {
  const TetMesh& mesh = piece.elements->mesh;
  const Tetrahedron& t = mesh.tetrahedra[at(element)];
  const Mat3 before = edge_matrix(mesh, element);
  Mat3 after = before;
  for (int i = 0; i < 3; ++i) after.col(i) += moves[at(t[at(i + 1)])] - moves[at(t[0])];
  const double volume = before.determinant();
  return volume > 0.0 ? after.determinant() / volume : 1.0;
}

}  // namespace

DeformedSolid deform(const SolidComplex& piece, const std::vector<Vec3>& moves, double flatness) {
  DeformedSolid deformed{piece, {}};
  SolidComplex& complex = deformed.complex;
  auto elements = std::make_shared<SolidElements>(*piece.elements);
  for (std::size_t v = 0; v < moves.size(); ++v) elements->mesh.positions[v] += moves[v];
  complex.elements = std::move(elements);
  for (SolidVertex& vertex : complex.vertices)
    for (std::size_t k = 0; k < 4; ++k)
      if (vertex.nodes[k] >= 0) vertex.position += vertex.weights[k] * moves[at(vertex.nodes[k])];
  move_kerfs(piece.elements->mesh, complex);
  deformed.tag_sources = FlatParts(complex, flatness).tag();
  for (SolidPart& cell : complex.cells) cell.is_measured = false;
  settle(complex);
  return deformed;
}

double least_volume_share(const SolidComplex& piece, const std::vector<Vec3>& moves) {
  double least = 1.0;
  for (const SolidPart& cell : piece.cells)
    least = std::min(least, element_volume_share(piece, cell.element, moves));
  return least;
}

double volume_share(const SolidComplex& piece, const std::vector<Vec3>& moves) {
  double before = 0.0, after = 0.0;
  for (const SolidPart& cell : piece.cells) {
    before += cell.volume;
    after += cell.volume * element_volume_share(piece, cell.element, moves);
  }
  return after / before;
}

}  // namespace shatterbox::geometry
