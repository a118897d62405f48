// What is left between cracks and is thinner than what the elements can tell of a crack: it bears no more
// than its strength either.
#pragma once

#include <vector>

#include "engine/geometry/solid_complex.h"
#include "engine/geometry/solid_mesh.h"

namespace shatterbox::fracture {

struct BridgeSetup {
  const std::vector<geometry::SolidContact>* contacts = nullptr;  // of the settled complex
  const std::vector<double>* tensions = nullptr;                  // |cells|, Pa: first principal stresses
  double strength = 0.0;                                          // Pa, of sound material
  double least_volume = 0.0;                                      // m3, of what parts
  double most_area = 0.0;                                         // m2, that there is energy for
  int id = 0;                                                     // tag of the faces
};

/// Where parts of a piece hang together only by cells at cracks that are under more tension than the
/// strength, the facets between the most strained of these open; what is smaller than `least_volume` stays
/// with others. The opened area, m2: 0 if nothing parts, or would need more than `most_area`.
double part_bridges(geometry::SolidComplex& complex, const BridgeSetup& setup);

}  // namespace shatterbox::fracture
