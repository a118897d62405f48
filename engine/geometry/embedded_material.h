// The material of a solid, divided among the tetrahedra that cover it: in each element the part of it that is
// inside the given surface, as polyhedra ("cells") bounded by convex flat polygons that neighbours share.
// This is what cuts start from (virtual nodes [MBF04]); the given surface stays the solid's surface.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/core/result.h"
#include "engine/geometry/solid_complex.h"
#include "engine/geometry/surface_crossings.h"
#include "engine/geometry/triangle_mesh.h"

namespace shatterbox::geometry {

struct EmbeddedMaterial {
  SolidMaterial material;              // facets between cells by face, then the outer ones, tagged with their
                                       // given triangles; cells ascending by element
  std::vector<std::uint8_t> is_whole;  // per cell: it fills its element; its facets are the four faces
  std::vector<double> volumes;         // per cell, m3
  std::vector<Vec3> centroids;         // per cell, m
};

/// The material inside `surface` (closed, wound counter-clockwise seen from outside, not crossing itself),
/// divided among `elements`, which must reach beyond it everywhere. Where the surface only touches vertices,
/// edges or faces of the elements, what an element has without a volume (1e-14 of its own) counts to the
/// neighbour it lies on; elements without material have no cell. Volumes sum to the volume inside the
/// surface, areas of the outer facets to its area, but for rounding. An error sentence, with the place, if
/// the elements do not cover the surface, or if it is open or crosses itself.
core::Result<EmbeddedMaterial> embed_surface(const SolidElements& elements, const TriangleMesh& surface);

/// Likewise, with the crossings known.
core::Result<EmbeddedMaterial> embed_surface(const SolidElements& elements, const TriangleMesh& surface,
                                             const EdgeTopology& surface_edges,
                                             const SurfaceCrossings& crossings);

/// Volume of the material in each element, m3 (|T|).
std::vector<double> embedded_volumes(const SolidElements& elements, const EmbeddedMaterial& embedded);

}  // namespace shatterbox::geometry
