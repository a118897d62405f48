// What is wrong with a mesh that came from outside, in sentences for the person who made it: what, where, how
// to mend it; and the mending itself where that is safe. Scale-free: a mesh in millimetres or kilometres gets
// the same answer.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/geometry/triangle_mesh.h"

namespace shatterbox::geometry {

enum class MeshFault : std::uint8_t {
  empty,                  // refused
  not_finite,             // refused: NaN, infinite or beyond 1e60 m
  index_out_of_range,     // refused
  duplicate_vertices,     // mended: equal to the bit, welded
  unused_vertices,        // mended: dropped
  degenerate_triangles,   // mended: no area; dropped, without opening a slit
  duplicate_triangles,    // mended: same three vertices; dropped
  non_manifold_edges,     // refused: more than two triangles on an edge
  non_manifold_vertices,  // mended: fans that meet in one vertex only get a vertex each
  mixed_winding,          // mended: turned to agree, and closed parts outwards
  not_orientable,         // refused: a Moebius strip
  loose_parts,            // refused, or noted where allowed (of solids always)
  slivers,                // noted: very thin triangles
  open_border,            // of solids: refused
  self_crossing,          // of solids: refused: triangles that pass through each other
};

enum class Severity : std::uint8_t { noted, mended, refused };

struct MeshFinding {
  MeshFault fault = MeshFault::empty;
  Severity severity = Severity::noted;
  int count = 0;      // how many vertices, triangles, edges or parts
  int vertex = -1;    // first place: vertex of the mesh as given, from 0; -1 where it is not about a vertex
  int triangle = -1;  // first place: triangle of the mesh as given, from 0; -1 likewise
  Vec3 place = Vec3::Zero();  // first place, m; zero where there is none
  std::string sentence;       // for people; numbers in it count from 1, as mesh files and tools do
};

struct MeshDiagnosis {
  std::vector<MeshFinding> findings;  // in the order of MeshFault
  int part_count = 0;                 // connected parts after mending; 0 if refused earlier
  bool is_closed = false;             // no border edge after mending

  bool refused() const;
  /// The finding of that kind, or nothing. The pointer is good as long as the diagnosis.
  const MeshFinding* find(MeshFault fault) const;
  /// All sentences of that severity, one a line; empty without any.
  std::string sentences(Severity severity) const;
};

struct MendOptions {
  bool allow_loose_parts = false;  // one rigid body of several parts
  double sliver_ratio = 1e-3;      // height over longest edge below which a triangle counts as a sliver
};

struct MendedMesh {
  TriangleMesh mesh;  // empty if refused
  MeshDiagnosis diagnosis;
  std::vector<int> triangle_source;  // per triangle: the triangle of the given mesh it was
  std::vector<int> vertex_source;    // per vertex: the vertex of the given mesh it was
};

/// What is wrong with a mesh and what mending would do.
MeshDiagnosis diagnose(const TriangleMesh& mesh, const MendOptions& options = {});

/// The mesh, mended: every edge has one or two triangles of agreeing winding, every vertex one fan, no
/// triangle is without area. No vertex is moved; one that is nearer to its neighbour than 1e-12 of the
/// triangle joins it. Closed parts that were inside out are turned, hollows in others are not. Mending a
/// mended mesh gives the same mesh. Refused meshes come back empty; diagnosis.refused() tells.
MendedMesh mend(const TriangleMesh& mesh, const MendOptions& options = {});

/// Likewise for the surface of a solid, which moreover is closed, faces outwards (a part inside another one
/// is the border of a hollow and faces into it) and does not pass through itself. Loose parts are allowed.
MendedMesh mend_solid(const TriangleMesh& mesh, const MendOptions& options = {});

}  // namespace shatterbox::geometry
