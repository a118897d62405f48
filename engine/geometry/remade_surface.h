// A clean surface in place of one that is open or passes through itself: the border of what that winds about
// (winding_number.h), by marching tetrahedra.
#pragma once

#include "engine/core/result.h"
#include "engine/geometry/triangle_mesh.h"

namespace shatterbox::geometry {

struct RemadeSurface {
  TriangleMesh mesh;           // closed, faces outwards, does not pass through itself
  double bridged_share = 0.0;  // of its area: over holes of the surface given
  double lost_share = 0.0;     // of the area given: loose sheets, and what is thinner than the spacing
};

/// What `surface` (triangles of agreeing windings) has a winding number above one half about. Its vertices
/// lie on the surface given, on edges of a grid of `spacing` (m), or over its holes; edges and corners are
/// cut off by about half of that. Fails with a sentence if nothing is enclosed, if the grid would be too
/// large, or if that would not be honest: more than 1/20 of it over holes, more than 1/100 of the surface
/// given lost, or its volume off by more than 1/20.
core::Result<RemadeSurface> remake_surface(const TriangleMesh& surface, double spacing);

}  // namespace shatterbox::geometry
