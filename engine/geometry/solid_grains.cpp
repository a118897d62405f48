#include "engine/geometry/solid_grains.h"

#include <algorithm>

#include "engine/core/index.h"
#include "engine/geometry/solid_cutter.h"

namespace shatterbox::geometry {
namespace {

using Size = std::size_t;
using core::at;

double value_at(const SolidVertex& vertex, const std::vector<double>& node_values) {
  double value = 0.0;
  for (Size k = 0; k < 4 && vertex.nodes[k] >= 0; ++k)
    value += vertex.weights[k] * node_values[at(vertex.nodes[k])];
  return value;
}

/// Cells with a vertex where the field is positive.
std::vector<int> find_cells_above_zero(const SolidComplex& complex,
                                       const std::vector<double>& vertex_values) {
  std::vector<char> is_above(complex.cells.size(), 0);
  for (const SolidFacet& facet : complex.facets) {
    if (facet.parts[0] >= 0) continue;
    const int* sides = complex.sides_of(facet);
    if (std::none_of(sides, sides + facet.side_count,
                     [&](int side) { return vertex_values[at(complex.side_begin(side))] > 0.0; }))
      continue;
    for (const int cell : facet.cells)
      if (cell >= 0) is_above[at(cell)] = 1;
  }
  std::vector<int> cells;
  for (Size c = 0; c < is_above.size(); ++c)
    if (is_above[c]) cells.push_back(static_cast<int>(c));
  return cells;
}

}  // namespace

void divide_into_grains(SolidComplex& complex, const GrainEnergies& energies, int first_id, double snap) {
  if (energies.empty()) return;
  for (SolidPart& cell : complex.cells) cell.grain = 0;
  // The least energy so far: one number at each vertex, whoever asks, so that neighbours agree where a new
  // grain meets a boundary of old ones.
  std::vector<double> least_at_nodes = energies[0];
  std::vector<double> least;
  for (const SolidVertex& vertex : complex.vertices) least.push_back(value_at(vertex, energies[0]));
  SolidCutter cutter(complex, snap);
  for (Size g = 1; g < energies.size(); ++g) {
    SolidCut cut;
    cut.kind = FacetKind::grain;
    cut.id = first_id + static_cast<int>(g);
    for (Size n = 0; n < least_at_nodes.size(); ++n)
      cut.node_values.push_back(least_at_nodes[n] - energies[g][n]);
    for (Size v = 0; v < least.size(); ++v)
      cut.vertex_values.push_back(least[v] - value_at(complex.vertices[v], energies[g]));
    cut.cells = find_cells_above_zero(complex, cut.vertex_values);
    cutter.cut(cut);
    for (Size c = 0; c < complex.cells.size(); ++c)
      if (cutter.side_of(static_cast<int>(c)) > 0) complex.cells[c].grain = static_cast<int>(g);
    for (Size n = 0; n < least_at_nodes.size(); ++n)
      least_at_nodes[n] = std::min(least_at_nodes[n], energies[g][n]);
    for (Size v = 0; v < complex.vertices.size(); ++v) {
      const double own = value_at(complex.vertices[v], energies[g]);
      if (v < least.size())
        least[v] = std::min(least[v], own);
      else
        least.push_back(own);  // new, on the new grain's boundary
    }
  }
  for (SolidFacet& facet : complex.facets)
    if (facet.kind == FacetKind::grain && facet.cells[0] >= 0 && facet.cells[1] >= 0 &&
        complex.cells[at(facet.cells[0])].grain == complex.cells[at(facet.cells[1])].grain)
      facet.tag = -1;
}

}  // namespace shatterbox::geometry
