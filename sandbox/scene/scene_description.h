// A scene as plain data: what the TOML says, checked, with defaults filled in, before any mesh is read or
// body made. Lengths in metres, SI units throughout, right-handed, y up.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "engine/body/body.h"
#include "engine/core/vec.h"
#include "engine/geometry/generators.h"
#include "engine/material/material.h"
#include "engine/world/description.h"
#include "engine/world/settings.h"
#include "sandbox/scene/event_description.h"
#include "sandbox/scene/problem.h"

namespace shatterbox::sandbox::scene {

struct MaterialEntry {
  Place place;
  std::string preset;  // the preset that its `like` chain ends at; empty without one
  material::Material material;
};

struct PairEntry {
  Place place;
  std::array<int, 2> materials{};  // numbers in SceneDescription::materials
  std::optional<double> friction, restitution;
};

// Shapes of shells and solids.
struct MeshFileShape {
  Place place;                     // where they are asked for
  std::vector<std::string> files;  // as found from the scene's folder; several are one body
};
struct SphereShape {
  double radius = 0.05;
};
struct PaneShape {
  double width = 1.0, height = 1.0;
};
struct SlabShape {
  Vec3 size = Vec3::Ones();  // m
};
struct FigureShape {
  double height = 0.5;  // m
};
/// The bottle and the vase of a shell: one sheet.
struct BottleSheet {
  geometry::BottleSizes sizes;
};
struct VaseSheet {
  geometry::VaseSizes sizes;
};
using MeshShape = std::variant<MeshFileShape, geometry::OrnamentSizes, SphereShape, geometry::BowlSizes,
                               PaneShape, geometry::BoatSizes, SlabShape, geometry::VaseSizes,
                               geometry::BottleSizes, geometry::EggSizes, FigureShape, BottleSheet, VaseSheet,
                               geometry::WineGlassSizes, geometry::LatheSizes>;

// Kinds of bodies.
struct PlaneForm {};
struct BoxForm {
  Vec3 size = Vec3::Ones();
};
struct SphereForm {
  double radius = 0.1;
};
struct CapsuleForm {
  double radius = 0.1;
  double length = 0.4;  // m, from tip to tip, along its own y axis
};
/// Where the frame of a mesh file begins: where the file says, or in the middle of its box or of its foot.
enum class MeshOrigin { file, middle, foot };
struct MeshForm {
  MeshShape shape;
  // m, of generated meshes, nothing: kUsualTriangles, a boat 300; of a shell's file at most, nothing: as is
  std::optional<double> edge_length;
  Vec3 scale = Vec3::Ones();
  std::optional<Vec3> size;              // the box that the mesh is stretched to, after `up`
  bool up_is_z = false;                  // the mesh's z axis points up in the scene
  MeshOrigin origin = MeshOrigin::file;  // of files: shapes have theirs
  std::optional<Vec3> wall;              // m: what copies of a brick fill
  bool is_breakable = true;
};
struct ShellForm : MeshForm {
  std::optional<double> thickness;  // m; nothing: the material's
};
struct SolidForm : MeshForm {
  std::optional<double> element_size;  // m, of the tetrahedra; nothing: about 10000 of them
  std::optional<int> grading;          // so many times as large they become inside; nothing: they do not
};
using Form = std::variant<PlaneForm, BoxForm, SphereForm, CapsuleForm, ShellForm, SolidForm>;

/// The mesh of a shell or a solid; nothing of what has none.
inline const MeshForm* find_mesh_form(const Form& form) {
  if (const auto* shell = std::get_if<ShellForm>(&form)) return shell;
  return std::get_if<SolidForm>(&form);
}
inline MeshForm* find_mesh_form(Form& form) {
  return const_cast<MeshForm*>(find_mesh_form(std::as_const(form)));
}

// What holds a body to the world. A box is in the mesh's own frame, after scale, size and up.
struct EdgeSupport {};
struct FootSupport {};
struct BoxSupport {
  Vec3 least = Vec3::Zero(), most = Vec3::Zero();
};
using Support = std::variant<std::monostate, EdgeSupport, FootSupport, BoxSupport>;

// The way of a scripted body.
struct PathEntry {
  std::vector<body::Keyframe> keys;  // at least two, ascending in time; angles in rad
  body::Between between = body::Between::smooth;
  Vec3 pivot = Vec3::Zero();  // m, in its own frame: what goes from position to position
};

// How the copies of a body stand.
enum class Layout : std::uint8_t {
  row,     // each by `spacing` from the one before it
  grid,    // count[0] along x, count[1] along y, count[2] along z
  layers,  // count[0] in all, in layers of `layer` along x and z, filled from their middle outwards, upwards
};

struct Repeat {
  Layout layout = Layout::row;
  std::array<int, 3> count{1, 1, 1};
  std::array<int, 2> layer{1, 1};
  Vec3 spacing = Vec3::Zero();  // m
  double bond = 0.0;            // of a grid: every other course is shifted along x by this share of a spacing
  Vec3 jitter = Vec3::Zero();   // m: greatest random offset along each axis
  double rotation_jitter = 0.0;  // degrees: greatest random turn, about a random axis
  double every = 0.0;            // s from copy to copy; 0: all are there from the start
  int total() const { return count[0] * count[1] * count[2]; }
};

struct LookEntry {
  std::string name;           // of kLookNames; empty: by the material
  std::vector<Vec3> colours;  // sRGB, 0..1; empty: the look's own; several: each copy gets one of them
};

struct BodyEntry {
  Place place;
  std::string name;
  Form form;
  int material = 0;  // number in SceneDescription::materials
  std::optional<double> density;
  Vec3 position = Vec3::Zero();
  Quat rotation = Quat::Identity();
  Vec3 velocity = Vec3::Zero();
  Vec3 angular_velocity = Vec3::Zero();
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();  // N, N m, world, all the time
  body::LockedAxes locked;
  body::Motion motion = body::Motion::dynamic;
  std::optional<PathEntry> path;  // of a scripted body
  Support support;
  std::string group;  // empty: none
  std::optional<double> contact_duration;
  Repeat repeat;
  LookEntry look;
  bool is_held_back = false;  // an event brings it in; until then it is not in the world
};

/// Whether it is a shell or a solid that may break.
inline bool can_break(const BodyEntry& body) {
  const MeshForm* form = find_mesh_form(body.form);
  return form != nullptr && form->is_breakable;
}

/// Who is held together: all of these, and their copies, by mortar where they face each other; two, at a
/// point.
struct JointEntry {
  Place place;
  std::string name;
  std::vector<BodyRef> partners;
  std::variant<world::MortarDescription, world::PivotDescription> form;
  bool is_chain = false;  // of points: each copy of the partner holds the next half way between them
  // Mortar of class M2.5 to M9 on clay bricks: about what EN 1996-1-1 tells as flexural and initial shear
  // strength, which are characteristic values (0.1 and 0.2 MPa), as a mean.
  double strength = 0.3e6;        // Pa, in tension
  double shear_strength = 0.3e6;  // Pa, without pressure
};

struct CameraKey {
  double at = 0.0;  // s
  Vec3 position = Vec3::Zero(), target = Vec3::Zero();
  double fov = 35.0;  // degrees, vertical
};
struct CameraEntry {
  Place place;
  std::optional<Vec3> position, target;  // nothing: chosen so that everything breakable is seen
  Vec3 up = Vec3::UnitY();
  double fov = 35.0;            // degrees, vertical
  std::vector<CameraKey> path;  // ascending in time; overrides the above
  BodyRef follow;               // who is kept in the middle
  std::optional<Vec3> offset;   // m, from that body; nothing: the camera stays where it is and turns
  double shutter = 0.0;         // share of a frame's time that it is open; 0: no time at all
  double aperture = 0.0;        // m, width of the lens; 0: everything is sharp
  std::variant<std::monostate, double, BodyRef> focus;  // m from the eye, or a body; else the target
  int samples = 16;  // pictures a frame, where shutter or aperture want several
};

struct LightEntry {
  std::string preset;                             // of kLightNames; empty: "studio"
  std::optional<Vec3> sun_direction, sun_colour;  // towards the sun; sRGB
  std::optional<double> sun_strength, sun_size;   // radiance of a white matt surface; degrees
  std::optional<double> sky;                      // strength
  bool casts_shadow = true;
};

struct RenderEntry {
  std::string look;    // of bodies without their own; empty: by their material
  std::string ground;  // of kGroundNames; empty: "plain" where there is a level plane
  std::optional<Vec3> ground_colour;
  double checker = 0.0;  // m a square; 0: plain
  std::string backdrop;  // of kBackdropNames; empty: the light preset's own
  std::string overlay = "none";
  std::optional<double> overlay_most;  // top of its scale, in its unit
  double exposure = 1.0;
  bool has_caption = false;
};

struct SceneDescription {
  std::string file, name;
  std::string goal;   // the first line of the file without its #: what must be seen
  std::string takes;  // how long a run of it takes, where that is long; else empty
  double seconds = 4.0;
  world::WorldSettings world;
  std::vector<MaterialEntry> materials;
  std::vector<PairEntry> pairs;
  std::vector<BodyEntry> bodies;
  std::vector<JointEntry> joints;
  std::vector<EventEntry> events;  // by time, then in the order of the text; last, who wait for something
  CameraEntry camera;
  LightEntry light;
  RenderEntry render;
  std::vector<std::string> warnings;
};

// Names that mean something to sandbox/view.
inline const std::vector<std::string> kLookNames{
    "ornament",  "glass",      "ceramic", "porcelain", "steel",    "wood",   "concrete",
    "brick",     "plaster",    "ice",     "eggshell",  "matt",     "glossy", "hidden",
    "aluminium", "terracotta", "frosted", "chrome",    "chocolate"};
inline const std::vector<std::string> kGroundNames{"none", "plain", "concrete", "wood", "dark", "checker"};
inline const std::vector<std::string> kBackdropNames{"studio", "dark", "sky", "white", "evening", "overcast"};
inline const std::vector<std::string> kLightNames{"studio", "noon", "evening", "overcast"};
inline const std::vector<std::string> kOverlayNames{"none",    "stress",   "pieces",    "grains",
                                                    "impacts", "velocity", "wireframe", "level_set"};

}  // namespace shatterbox::sandbox::scene
