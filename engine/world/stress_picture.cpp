#include "engine/world/stress_picture.h"

#include <algorithm>

#include "engine/core/index.h"
#include "engine/world/fragile.h"

namespace shatterbox::world {

using core::at;

std::vector<double> find_surface_stress(const body::Shape& shape, const Fragile& fragile,
                                        const std::vector<double>& element_stress) {
  std::vector<double> stress;
  for (const int element : shape.triangle_elements) stress.push_back(element_stress[at(element)]);
  const auto* solid = std::get_if<fracture::SolidSubject>(&fragile.subject);
  if (solid == nullptr || !stress.empty()) return stress;
  const geometry::SolidComplex& complex = *solid->complex;
  stress.assign(shape.surface.triangles.size(), 0.0);
  for (const int f : geometry::find_border_facets(complex)) {
    const geometry::SolidFacet& facet = complex.facets[at(f)];
    const int cell = facet.cells[0] < 0 ? facet.cells[1] : facet.cells[0];
    double& here = stress[at(facet.tag)];
    here = std::max(here, element_stress[at(complex.cells[at(cell)].element)]);
  }
  return stress;
}

}  // namespace shatterbox::world
