// SceneDescription -> World: meshes are built, copies placed, and every body of the scene is kept in the
// engine's words, so that events can throw it later.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/geometry/bvh.h"
#include "engine/geometry/tet_quality.h"
#include "engine/world/world.h"
#include "sandbox/scene/scene_description.h"

namespace shatterbox::sandbox::scene {

/// One [[body]], ready to be added at its own place.
struct BodyPlan {
  world::BodyDescription description;
  geometry::Box box;             // m, about all of it, in the frame of its mesh; of planes about nothing
  double bounding_radius = 0.0;  // m, about the frame's origin; 0 for planes
  Vec3 centre = Vec3::Zero();    // centre of mass in the mesh's frame, m
  double reach = 0.0;            // m, of the farthest point from there
};

struct ScenePlan {
  std::vector<BodyPlan> bodies;    // by the numbers of SceneDescription::bodies
  std::vector<std::string> notes;  // what was mended in meshes, what is beyond the engine's limits
};

/// Where an original body came from.
struct Origin {
  int entry = 0;  // number in SceneDescription::bodies
  int copy = 0;   // of its repeat, from 0
};

struct BuiltScene {
  world::World world;
  ScenePlan plan;
  std::map<body::BodyId, Origin> origins;  // of original bodies; the script adds to it
};

/// Reads and mends meshes, finds supports: all that can go wrong before a world exists. Nothing if `problems`
/// got any.
std::optional<ScenePlan> plan_bodies(const SceneDescription& scene, Problems& problems);

/// Told before each of SceneDescription::bodies is made: its number, and what is done.
using BuildWatch = std::function<void(int body, const std::string& note)>;

/// Makes the world with all bodies that neither an event nor `every` holds back. Nothing if `problems` got
/// any.
std::optional<BuiltScene> build_world(const SceneDescription& scene, Problems& problems,
                                      const BuildWatch& watch = {});

/// The same of bodies that are planned already: `plan` has the bodies of `scene`.
std::optional<BuiltScene> raise_world(const SceneDescription& scene, ScenePlan plan, Problems& problems,
                                      const BuildWatch& watch = {});

/// Of each [[body]] that is a solid which can break, in their order, how well-shaped the tetrahedra are of
/// its first copy that is there.
struct BodyTetrahedra {
  int entry = 0;  // number in SceneDescription::bodies
  geometry::TetQuality quality;
};
std::vector<BodyTetrahedra> find_tetrahedra(const BuiltScene& built);

/// The places of the copies of a body, in the order of their numbers: grids with x fastest, then y, then z;
/// jitter depends on (seed, number of the body, number of the copy) only.
std::vector<Pose> copy_poses(const BodyEntry& body, std::uint64_t seed, std::uint64_t body_number);

/// The path of one copy, which stands at `pose`: its first key is there.
world::PathDescription path_of(const BodyEntry& body, const Pose& pose);

/// What copy number `copy` of body number `entry` is called: "boats", or "boats[3]" where there are several.
std::string copy_name(const BodyEntry& body, int copy);

}  // namespace shatterbox::sandbox::scene
