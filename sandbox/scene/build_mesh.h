// The mesh of a shell or a solid: generated or read, mended, turned and stretched as the scene says; and what
// its support clamps.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/geometry/triangle_mesh.h"
#include "engine/world/description.h"
#include "sandbox/scene/scene_description.h"

namespace shatterbox::sandbox::scene {

struct BuiltMesh {
  geometry::TriangleMesh mesh;      // the mesh's own frame after scale, size and up, m
  std::vector<std::uint8_t> parts;  // per triangle: geometry::Part
};

/// m: edges of about as many triangles as generated meshes have that ask for no other.
double usual_edge_length(const geometry::TriangleMesh& mesh);

/// Builds the mesh of `form`. Nothing if it cannot be had, with problems at `place`; what was mended goes to
/// `notes`.
std::optional<BuiltMesh> build_mesh(const MeshForm& form, const Place& place, Problems& problems,
                                    std::vector<std::string>& notes);

/// The vertices that `support` holds, ascending; `rotation` turns the mesh into the scene (the foot is what
/// is lowest there). Empty with a problem if it holds none.
std::vector<int> find_clamped(const geometry::TriangleMesh& mesh, const Quat& rotation,
                              const Support& support, const Place& place, Problems& problems);

/// The region that `support` holds of a solid, likewise: the points in all of these.
std::vector<world::HalfSpace> find_held(const geometry::TriangleMesh& mesh, const Quat& rotation,
                                        const Support& support, const Place& place, Problems& problems);

}  // namespace shatterbox::sandbox::scene
