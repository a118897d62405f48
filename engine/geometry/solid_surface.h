// The one closed surface of a piece of a solid, for contact, pictures, audit and export: what is left of the
// given surface, and the crack faces that part it from other pieces. Cracks that end inside have their faces
// in it and are left out.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/geometry/mass_properties.h"
#include "engine/geometry/solid_complex.h"
#include "engine/geometry/triangle_mesh.h"

namespace shatterbox::geometry {

struct SolidSurface {
  TriangleMesh mesh;                  // material space; each edge has two triangles, each vertex one fan
  std::vector<int> triangle_sources;  // per triangle: the given triangle it is part of; -1 on crack faces
  std::vector<int> triangle_cells;    // per triangle: the cell behind it
  std::vector<int> triangle_grains;   // per triangle: that cell's grain, -1 without
  std::vector<std::uint8_t> is_crack_face;  // per triangle
  std::vector<int> vertex_sources;  // per vertex: the vertex of the complex; -1 in the middle of an edge
};

/// The border of all cells of a settled complex, which is one piece's. What is left of a given triangle is
/// divided anew, without the elements' faces. Vertices and edges in which parts
/// touch that hold together nowhere near are there once for each part.
SolidSurface extract_surface(const SolidComplex& piece);

/// Mass, centre and inertia of the true cut: the solid of `density` kg/m3 inside the border of a settled
/// complex.
MassProperties solid_mass_properties(const SolidComplex& piece, double density);

}  // namespace shatterbox::geometry
