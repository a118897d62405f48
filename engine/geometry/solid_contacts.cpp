#include "engine/geometry/solid_contacts.h"

#include <algorithm>
#include <utility>

#include "engine/core/disjoint_sets.h"
#include "engine/core/index.h"
#include "engine/core/parallel.h"

namespace shatterbox::geometry {
namespace {

using Size = std::size_t;
using core::at;

/// Nodes of elements that are cut, or have a crack on a face: only these can have several copies.
std::vector<char> find_nodes_at_cracks(const SolidComplex& complex) {
  std::vector<char> is_at_crack(complex.elements->mesh.positions.size(), 0);
  for (const SolidFacet& facet : complex.facets) {
    if (facet.parts[0] >= 0 || (facet.kind != FacetKind::crack && facet.kind != FacetKind::grain)) continue;
    for (const int c : facet.cells)
      if (c >= 0)
        for (const int node : complex.elements->mesh.tetrahedra[at(complex.cells[at(c)].element)])
          is_at_crack[at(node)] = 1;
  }
  return is_at_crack;
}

}  // namespace

std::vector<SolidContact> find_solid_contacts(const SolidComplex& complex) {
  constexpr Size kGrain = 8192;
  const auto between = core::find_where(complex.facets.size(), kGrain, [&](Size f) {
    const SolidFacet& facet = complex.facets[f];
    return facet.parts[0] < 0 && facet.kind != FacetKind::crack && facet.cells[0] >= 0 &&
           facet.cells[1] >= 0 && facet.cells[0] != facet.cells[1];
  });
  std::vector<SolidContact> contacts(between.size());
  core::parallel_for(between.size(), kGrain, [&](Size k) {
    const SolidFacet& facet = complex.facets[at(between[k])];
    const auto [a, b] = std::minmax(facet.cells[0], facet.cells[1]);
    contacts[k] = {a, b, facet_area_vector(complex, facet).norm()};
  });
  // By cell_a in linear time, then each cell's few by cell_b; facets of one pair add up in their order.
  std::vector<int> next(complex.cells.size() + 1, 0);
  for (const SolidContact& contact : contacts) ++next[at(contact.cell_a) + 1];
  for (Size c = 0; c < complex.cells.size(); ++c) next[c + 1] += next[c];
  std::vector<SolidContact> sorted(contacts.size());
  for (const SolidContact& contact : contacts) sorted[at(next[at(contact.cell_a)]++)] = contact;
  Size kept = 0;
  for (Size first = 0; first < sorted.size();) {
    Size last = first;
    while (last < sorted.size() && sorted[last].cell_a == sorted[first].cell_a) ++last;
    std::stable_sort(sorted.begin() + static_cast<std::ptrdiff_t>(first),
                     sorted.begin() + static_cast<std::ptrdiff_t>(last),
                     [](const SolidContact& p, const SolidContact& q) { return p.cell_b < q.cell_b; });
    const Size begin = kept;
    for (; first < last; ++first) {
      if (kept > begin && sorted[kept - 1].cell_b == sorted[first].cell_b)
        sorted[kept - 1].area += sorted[first].area;
      else
        sorted[kept++] = sorted[first];
    }
  }
  sorted.resize(kept);
  return sorted;
}

std::vector<int> label_parts(std::size_t cell_count, const std::vector<SolidContact>& contacts,
                             int& part_count) {
  core::DisjointSets parts(cell_count);
  for (const SolidContact& contact : contacts) parts.unite(contact.cell_a, contact.cell_b);
  std::vector<int> label(cell_count, -1);
  part_count = 0;
  for (std::size_t c = 0; c < cell_count; ++c) {
    const int root = parts.find(static_cast<int>(c));
    label[c] = root == static_cast<int>(c) ? part_count++ : label[static_cast<std::size_t>(root)];
  }
  return label;
}

int count_parts(const SolidComplex& complex) {
  int count = 0;
  label_parts(complex.cells.size(), find_solid_contacts(complex), count);
  return count;
}

SolidMesh make_solid_mesh(const SolidComplex& complex, const std::vector<SolidContact>& contacts) {
  SolidMesh mesh;
  mesh.elements = complex.elements;
  const std::vector<Tetrahedron>& tetrahedra = complex.elements->mesh.tetrahedra;
  const std::vector<char> is_at_crack = find_nodes_at_cracks(complex);
  core::DisjointSets copies(4 * complex.cells.size());
  for (const SolidContact& contact : contacts) {
    const Tetrahedron& nodes_a = tetrahedra[at(complex.cells[at(contact.cell_a)].element)];
    const Tetrahedron& nodes_b = tetrahedra[at(complex.cells[at(contact.cell_b)].element)];
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j)
        if (nodes_a[at(i)] == nodes_b[at(j)] && is_at_crack[at(nodes_a[at(i)])])
          copies.unite(4 * contact.cell_a + i, 4 * contact.cell_b + j);
  }
  std::vector<int> number_of_node(is_at_crack.size(), -1);
  std::vector<int> number_of_copy(4 * complex.cells.size(), -1);
  mesh.cells.reserve(complex.cells.size());
  for (Size c = 0; c < complex.cells.size(); ++c) {
    const SolidPart& part = complex.cells[c];
    SolidCell cell{part.element, {}, std::max(part.volume, 0.0), part.centroid, part.grain};
    for (Size i = 0; i < 4; ++i) {
      const int node = tetrahedra[at(part.element)][i];
      int& number = is_at_crack[at(node)] ? number_of_copy[at(copies.find(static_cast<int>(4 * c + i)))]
                                          : number_of_node[at(node)];
      if (number < 0) {
        number = static_cast<int>(mesh.vertex_source.size());
        mesh.vertex_source.push_back(node);
      }
      cell.vertices[i] = number;
    }
    mesh.cells.push_back(cell);
  }
  return mesh;
}

}  // namespace shatterbox::geometry
