// Which way a vertex of a piece's surface stands back from the crack faces about it.
#pragma once

#include <optional>
#include <vector>

#include "engine/geometry/solid_surface.h"

namespace shatterbox::geometry {

/// What the faces about each vertex ask of its shift: planes of crack faces, and of outer ones.
struct VertexFaces {
  std::vector<std::vector<Vec3>> cracks, outers;
};

/// Adds a unit normal to those of crack faces or of outer ones, if it is new: what stands back may do so from
/// one of two that hardly turn, what slides must come before neither.
void add_normal(std::vector<Vec3>& cracks, std::vector<Vec3>& outers, bool is_crack, const Vec3& normal);

/// Whether a vertex stands back from a triangle of its own: from a crack face, but one that has stood back
/// counts as an outer one, unless the vertex could not be given its place in that.
bool stands_back(const SolidSurface& surface, int triangle, int vertex);

/// The normals about each vertex that stands back.
VertexFaces collect_faces(const SolidSurface& surface);

/// How far, and where to, a vertex retreats from crack faces (m, like `kerf`), along outer ones where it can;
/// zero where no way leads inwards.
Vec3 retreat(const std::vector<Vec3>& cracks, const std::vector<Vec3>& outers, double kerf);

/// A face with less area than this, share of its squared size, has no normal.
inline constexpr double kFlatFace = 1e-14;

/// The unit normal of a triangle, if it has one.
std::optional<Vec3> find_normal(const TriangleMesh& mesh, const Triangle& triangle);

}  // namespace shatterbox::geometry
