// The kerf of a piece's surface: its crack faces stand back, so that pieces are born apart.
#pragma once

#include "engine/geometry/solid_surface.h"

namespace shatterbox::geometry {

/// Moves the vertices of a piece's surface (extract_surface) back from all crack faces about them by `kerf` m
/// (> 0), by less where the material is narrower than four kerfs. Vertices of the outer surface slide along
/// it. No face leaves the piece. Returns the narrowest stand-off of a crack vertex, m: zero where one found
/// no room; `kerf` without any.
double stand_back(SolidSurface& surface, double kerf);

}  // namespace shatterbox::geometry
