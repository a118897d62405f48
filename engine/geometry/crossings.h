// Do triangles cross? Transversal crossings of two meshes, by signs of volumes with a bound on their rounding
// errors: what touches, or might only touch, is not counted.
#pragma once

#include <vector>

#include "engine/geometry/triangle_mesh.h"

namespace shatterbox::geometry {

/// Does the open segment p-q pass through the inside of triangle (a, b, c)? Perhaps: rounding could have
/// decided it.
enum class Piercing { no, perhaps, yes };
Piercing pierce(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c);

/// True if it surely does.
bool segment_pierces_triangle(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c);

/// Number of pairs (a triangle of one mesh, a triangle of another) that cross, over all pairs of `meshes`,
/// which are in one space.
long count_crossing_pairs(const std::vector<TriangleMesh>& meshes);

}  // namespace shatterbox::geometry
