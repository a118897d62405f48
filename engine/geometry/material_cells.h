// From polygons to cells: which polygons of an element bound one connected part of its material. For
// embedded_material.cpp.
#pragma once

#include <vector>

#include "engine/core/vec.h"

namespace shatterbox::geometry {

/// A polygon of one element, counter-clockwise seen from outside of the material.
struct ElementPolygon {
  const int* corners = nullptr;
  int corner_count = 0;
  bool is_reversed = false;  // the list runs clockwise
  int part = -1;             // number of the connected part, set by divide_into_parts
};

struct MaterialPart {
  double volume = 0.0;           // m3
  Vec3 centroid = Vec3::Zero();  // m; of a part without a volume some point of it
};

/// Divides polygons that together are closed into the borders of connected parts: polygons that share a side
/// belong together, and a hollow belongs to the part around it. Parts are numbered in the order of their
/// first polygons. `least_volume` (m3): what encloses less is flat, not a hollow.
std::vector<MaterialPart> divide_into_parts(const std::vector<Vec3>& positions,
                                            std::vector<ElementPolygon>& polygons, double least_volume);

}  // namespace shatterbox::geometry
