// The kerf of a piece's surface: its crack faces stand back, so that pieces are born apart.
#pragma once

#include "engine/geometry/solid_surface.h"
#include "engine/geometry/surface_distance.h"

namespace shatterbox::geometry {

/// Moves the vertices of a piece's surface (extract_surface) back from all crack faces about them by `kerf` m
/// (> 0), by less where the material is narrower than four kerfs. Vertices of the outer surface slide along
/// it. No face leaves the piece. A vertex at which the material goes on from one side of a crack to the other
/// becomes two or three, for it cannot stand back from both. Faces that stood back before count as outer
/// ones; `whole`, the surface that the piece is cut from, tells where such a face is at vertices to which
/// keep_kerf could give no place. Returns the narrowest stand-off of a crack vertex, m: zero where one found
/// no room; `kerf` without any.
double stand_back(SolidSurface& surface, double kerf, const SurfaceDistance* whole = nullptr);

/// Lets a piece (settled) know its surface, after stand_back: surfaces of what is cut from it later have
/// their places in it, and stick out of it nowhere. Vertices that are in it more than once have no such
/// place: they stand back anew.
void keep_kerf(SolidComplex& piece, const SolidSurface& surface);

}  // namespace shatterbox::geometry
