// Makes a mesh of a smooth surface irregular without making its triangles bad: vertices take random steps
// along the surface, edges are flipped towards Delaunay, and no step is taken that makes a sharp angle
// sharper.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "engine/core/vec.h"
#include "engine/geometry/triangle_mesh.h"

namespace shatterbox::geometry {

using Tangents = Eigen::Matrix<double, 3, 2>;

/// Where the vertices of a mesh may go.
struct SurfaceWalk {
  std::vector<Vec3> parameters;  // |V|: what `position` understands
  std::vector<Vec2> freedom;     // |V|: 1 or 0 for steps along either tangent
  std::vector<int> creases;      // |V|: line of edges that must stay, -1: none
  std::function<Vec3(const Vec3& parameter)> position;
  std::function<Tangents(const Vec3& parameter)> tangents;               // two unit vectors at a right angle
  std::function<Vec3(const Vec3& parameter, const Vec2& step)> stepped;  // step in m along the tangents
};

/// Moves the vertices by random steps of at most `jitter` edge lengths, several rounds, flipping edges in
/// between; then mends what sharp angles there were. jitter = 0: only flips and mends. The number of vertices
/// and triangles and the order of vertices stay; the triangles' order stays too, so what is known of them as
/// a region (between two creases) stays true.
void make_irregular(TriangleMesh& mesh, SurfaceWalk& walk, double jitter, std::uint64_t seed);

/// Cosine of the sharpest angle of a triangle; 1 if it has no area.
double sharpest_cosine(const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace shatterbox::geometry
