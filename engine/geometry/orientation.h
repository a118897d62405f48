// On which side? Exact signs of volumes, with a rule for zero: where a mesh of tetrahedra and a surface touch
// without crossing (a vertex on a face, edges that meet), the surface counts as moved by (e, e^2, e^3), e
// positive and smaller than anything. All answers are those of one and the same moved surface, so they agree
// with each other; a motion of the whole keeps a surface that does not cross itself so.
#pragma once

#include <array>

#include "engine/core/vec.h"
#include "engine/geometry/expansion.h"

namespace shatterbox::geometry {

/// Sign of (b - a) x (c - a) . (d - a): 1 if d is on the side from which a, b, c turn counter-clockwise, -1
/// on the other, 0 if exactly in their plane.
int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// (b - a) x (c - a) . (d - a), to a few units in the last place even if almost everything cancels, m3.
double oriented_volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// The side of the surface's triangle a, b, c on which the mesh's vertex `p` lies: 1 if in front of it, -1
/// behind; 0 only if the triangle has no area.
int side_of_surface(const std::array<Vec3, 3>& triangle, const Vec3& p);

/// The side of the mesh's face on which the surface's vertex `p` lies; 0 only if the face has no area.
int side_of_face(const std::array<Vec3, 3>& face, const Vec3& p);

/// Sign of (b - a) x (p - a) . (q - a), where a-b is an edge of the mesh and p-q of the surface; 0 only if
/// they are parallel and in one plane.
int turn_of_edges(const Vec3& a, const Vec3& b, const Vec3& p, const Vec3& q);

/// Does the mesh's edge a-b pass through the surface's triangle? 1 if from behind it to the front, -1 if from
/// the front, 0 if it does not.
int passage_of_edge(const Vec3& a, const Vec3& b, const std::array<Vec3, 3>& triangle);

/// Does the surface's edge p-q pass through the mesh's face? 1 if to the side from which the face's corners
/// turn counter-clockwise, -1 if from it, 0 if it does not.
int passage_of_surface_edge(const Vec3& p, const Vec3& q, const std::array<Vec3, 3>& face);

/// True if, on the way from a to b, the triangle `first` is passed before `second`. The edge passes through
/// both; the answer for two triangles in one plane is false.
bool is_passed_before(const Vec3& a, const Vec3& b, const std::array<Vec3, 3>& first,
                      const std::array<Vec3, 3>& second);

}  // namespace shatterbox::geometry
