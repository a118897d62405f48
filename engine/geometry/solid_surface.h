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
  std::vector<int> triangle_facets;   // per triangle: the facet it is of; on what is divided anew one of
                                      // them; -1: of none
  std::vector<std::uint8_t> is_crack_face;  // per triangle
  std::vector<std::uint8_t> is_old_face;    // per triangle: a crack face that has stood back before
  std::vector<int> vertex_sources;     // per vertex: the vertex of the complex; -1 in the middle of an edge
  std::vector<std::uint8_t> has_kerf;  // per vertex: as the complex has it

  /// A vertex of the complex that the surface does without, on a straight edge between two of its own.
  struct OnEdge {
    int source, from, to;
    double share;  // of the way
  };
  std::vector<OnEdge> on_edges;
};

/// The border of all cells of a settled complex, which is one piece's. What is left of a given triangle, or
/// of a plane wall (SolidFacet::plane), is divided anew, without the elements' faces. Where an earlier
/// surface stood back (keep_kerf), this one has its place. Vertices and edges in which parts touch that hold
/// together nowhere near are there once for each part.
SolidSurface extract_surface(const SolidComplex& piece);

/// Mass, centre and inertia of the true cut: the solid of `density` kg/m3 inside the border of a settled
/// complex.
MassProperties solid_mass_properties(const SolidComplex& piece, double density);

}  // namespace shatterbox::geometry
