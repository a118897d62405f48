#include "engine/fracture/solid_bridges.h"

#include <algorithm>

#include "engine/core/disjoint_sets.h"
#include "engine/core/index.h"

namespace shatterbox::fracture {
namespace {

using Size = std::size_t;
using core::at;
using geometry::FacetKind;

constexpr int kRings = 2;  // of cells about a crack that can belong to a bridge

bool is_crack(const geometry::SolidFacet& facet) {
  return facet.kind == FacetKind::crack || facet.kind == FacetKind::old_crack;
}

/// Cells with a crack's face, and those about them.
std::vector<char> find_cells_at_cracks(const geometry::SolidComplex& complex,
                                       const std::vector<geometry::SolidContact>& contacts) {
  std::vector<char> is_near(complex.cells.size(), 0);
  for (const geometry::SolidFacet& facet : complex.facets)
    if (facet.parts[0] < 0 && is_crack(facet))
      for (const int cell : facet.cells)
        if (cell >= 0) is_near[at(cell)] = 1;
  for (int ring = 0; ring < kRings; ++ring) {
    const std::vector<char> before = is_near;
    for (const geometry::SolidContact& contact : contacts)
      if (before[at(contact.cell_a)] != before[at(contact.cell_b)])
        is_near[at(contact.cell_a)] = is_near[at(contact.cell_b)] = 1;
  }
  return is_near;
}

}  // namespace

double part_bridges(geometry::SolidComplex& complex, const BridgeSetup& setup) {
  const std::vector<geometry::SolidContact>& contacts = *setup.contacts;
  const std::vector<double>& tensions = *setup.tensions;
  const std::vector<char> is_near = find_cells_at_cracks(complex, contacts);
  const auto gives_way = [&](int cell) {
    return is_near[at(cell)] != 0 && tensions[at(cell)] > setup.strength;
  };
  core::DisjointSets lumps(complex.cells.size());
  std::vector<const geometry::SolidContact*> bridging;
  for (const geometry::SolidContact& contact : contacts) {
    if (gives_way(contact.cell_a) && gives_way(contact.cell_b))
      bridging.push_back(&contact);
    else
      lumps.unite(contact.cell_a, contact.cell_b);
  }
  std::vector<double> volumes(complex.cells.size(), 0.0);
  for (Size c = 0; c < complex.cells.size(); ++c)
    volumes[at(lumps.find(static_cast<int>(c)))] += complex.cells[c].volume;
  // The least strained hold together, so that what parts two lumps is the most strained between them.
  const auto strain = [&](const geometry::SolidContact* contact) {
    return tensions[at(contact->cell_a)] + tensions[at(contact->cell_b)];
  };
  std::stable_sort(bridging.begin(), bridging.end(),
                   [&](const auto* a, const auto* b) { return strain(a) < strain(b); });
  for (const geometry::SolidContact* contact : bridging) {
    const int a = lumps.find(contact->cell_a), b = lumps.find(contact->cell_b);
    if (a == b) continue;
    const double volume_a = volumes[at(a)], volume_b = volumes[at(b)];
    if (std::min(volume_a, volume_b) >= setup.least_volume) continue;
    lumps.unite(a, b);
    volumes[at(lumps.find(a))] = volume_a + volume_b;
  }
  double area = 0.0;
  std::vector<geometry::SolidFacet*> opened;
  for (geometry::SolidFacet& facet : complex.facets) {
    if (facet.parts[0] >= 0 || facet.cells[0] < 0 || facet.cells[1] < 0 || is_crack(facet)) continue;
    if (lumps.find(facet.cells[0]) == lumps.find(facet.cells[1])) continue;
    opened.push_back(&facet);
    area += facet_area_vector(complex, facet).norm();
  }
  if (area > setup.most_area) return 0.0;
  for (geometry::SolidFacet* facet : opened) {
    facet->kind = FacetKind::crack;
    facet->tag = setup.id;
  }
  return area;
}

}  // namespace shatterbox::fracture
