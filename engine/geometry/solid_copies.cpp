#include "engine/geometry/solid_copies.h"

#include <algorithm>
#include <map>
#include <memory>
#include <utility>

#include "engine/core/index.h"

namespace shatterbox::geometry {
namespace {

using Size = std::size_t;
using core::at;

/// Writes the material of a cracked solid anew, facet by facet.
class Copier {
 public:
  Copier(const SolidComplex& piece, const SolidMesh& mesh) : piece_(piece), mesh_(mesh) {}

  CopiedSolid copy() {
    auto elements = copy_cells();
    for (const SolidFacet& facet : piece_.facets)
      if (facet.parts[0] < 0 && (facet.cells[0] >= 0 || facet.cells[1] >= 0)) copy_facet(facet);
    CopiedSolid copied;
    copied.complex = build_solid_complex(std::move(elements), material_);
    for (Size f = 0; f < planes_.size(); ++f) copied.complex.facets[f].plane = planes_[f];
    for (Size c = 0; c < piece_.cells.size(); ++c) copied.complex.cells[c].grain = piece_.cells[c].grain;
    copied.element_sources = std::move(element_sources_);
    copied.vertex_sources = mesh_.vertex_source;
    copied.lips = std::move(lips_);
    return copied;
  }

 private:
  std::shared_ptr<const SolidElements> copy_cells() {
    const TetMesh& from = piece_.elements->mesh;
    auto elements = std::make_shared<SolidElements>();
    for (const int source : mesh_.vertex_source)
      elements->mesh.positions.push_back(from.positions[at(source)]);
    std::map<Tetrahedron, int> known;  // one element has one source: its vertices are copies of that one's
    for (const SolidCell& cell : mesh_.cells) {
      const auto [found, is_new] = known.try_emplace(cell.vertices, static_cast<int>(known.size()));
      if (is_new) {
        elements->mesh.tetrahedra.push_back(cell.vertices);
        element_sources_.push_back(cell.element);
      }
      material_.cell_elements.push_back(found->second);
    }
    return elements;
  }

  /// A vertex of the piece as a cell of its has it.
  int copy_vertex(int number, int cell) {
    SolidVertex vertex = piece_.vertices[at(number)];
    const Tetrahedron& nodes = piece_.elements->mesh.tetrahedra[at(piece_.cells[at(cell)].element)];
    std::array<std::pair<int, double>, 4> own;
    Size count = 0;
    for (; count < 4 && vertex.nodes[count] >= 0; ++count) {
      const auto corner = std::find(nodes.begin(), nodes.end(), vertex.nodes[count]) - nodes.begin();
      own[count] = {mesh_.cells[at(cell)].vertices[static_cast<Size>(corner)], vertex.weights[count]};
    }
    std::sort(own.begin(), own.begin() + static_cast<std::ptrdiff_t>(count));
    for (Size k = 0; k < count; ++k) std::tie(vertex.nodes[k], vertex.weights[k]) = own[k];
    const auto [found, is_new] =
        vertices_.try_emplace({number, vertex.nodes}, static_cast<int>(material_.vertices.size()));
    if (is_new) material_.vertices.push_back(vertex);
    return found->second;
  }

  std::vector<int> corners_of(const SolidFacet& facet, int cell) {
    std::vector<int> corners;
    for (int i = 0; i < facet.side_count; ++i)
      corners.push_back(copy_vertex(piece_.side_begin(piece_.sides_of(facet)[i]), cell));
    return corners;
  }

  void add(const SolidFacet& facet, const std::vector<int>& corners, std::array<int, 2> cells,
           FacetKind kind) {
    FacetLoop loop{static_cast<int>(material_.corners.size()), static_cast<int>(corners.size()), cells, kind,
                   facet.tag};
    material_.corners.insert(material_.corners.end(), corners.begin(), corners.end());
    material_.facets.push_back(loop);
    planes_.push_back(facet.plane);
  }

  void copy_facet(const SolidFacet& facet) {
    const auto& [behind, in_front] = facet.cells;
    const std::vector<int> back = corners_of(facet, behind >= 0 ? behind : in_front);
    if (facet.kind != FacetKind::crack || behind < 0 || in_front < 0) {
      add(facet, back, facet.cells, facet.kind);
      return;
    }
    const std::vector<int> front = corners_of(facet, in_front);
    if (front == back) {
      add(facet, back, facet.cells, FacetKind::grain);
      return;
    }
    const int number = static_cast<int>(material_.facets.size());
    lips_.push_back({number, number + 1});
    add(facet, back, {behind, -1}, facet.kind);
    add(facet, front, {-1, in_front}, facet.kind);
  }

  const SolidComplex& piece_;
  const SolidMesh& mesh_;
  SolidMaterial material_;
  std::vector<std::int16_t> planes_;  // of its facets
  std::vector<int> element_sources_;
  std::vector<std::array<int, 2>> lips_;
  std::map<std::pair<int, std::array<int, 4>>, int> vertices_;  // by source and nodes
};

}  // namespace

CopiedSolid copy_elements(const SolidComplex& piece, const SolidMesh& mesh) {
  return Copier(piece, mesh).copy();
}

}  // namespace shatterbox::geometry
