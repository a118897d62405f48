// The stress of a body as its surface shows it, for pictures.
#pragma once

#include <vector>

#include "engine/body/shape.h"

namespace shatterbox::world {

struct Fragile;

/// The last evaluated stress of a body that can break: greatest principal stress over the event and, of a
/// shell, both faces, Pa.
struct StressPicture {
  std::vector<double> triangle_stress;  // per triangle of the shape's surface, Pa; empty: never evaluated
  double strength = 0.0;                // Pa
};

/// Per triangle of the shape's surface, Pa, from `element_stress` (|T| of the element mesh, Pa). Of a solid
/// that was never cut nor dented, whose surface goes through many elements: the greatest behind the triangle.
std::vector<double> find_surface_stress(const body::Shape& shape, const Fragile& fragile,
                                        const std::vector<double>& element_stress);

}  // namespace shatterbox::world
