// What a new body is, in the caller's words: its form, place, motion and how it is held.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "engine/body/body.h"
#include "engine/core/vec.h"
#include "engine/geometry/triangle_mesh.h"

namespace shatterbox::world {

/// An infinitely thin triangle mesh with a thickness for mass and stress. The mesh must have passed
/// geometry::diagnose.
struct ShellDescription {
  geometry::TriangleMesh mesh;      // in the mesh's own frame, m
  std::vector<std::uint8_t> parts;  // per triangle: number of the look; empty for all 0
  double thickness = 1e-3;          // m
  std::vector<int> clamped;         // vertices held by the world (a frame, a foot); empty: a free body
  bool is_breakable = true;         // scripted ones are not
};

/// The points p, in the mesh's own frame, with normal . p <= offset (m).
struct HalfSpace {
  Vec3 normal = Vec3::UnitY();  // unit, outwards
  double offset = 0.0;
};

/// The inside of a closed triangle mesh, wound counter-clockwise seen from outside. The mesh must have passed
/// geometry::diagnose.
struct SolidDescription {
  geometry::TriangleMesh mesh;      // in the mesh's own frame, m
  std::vector<std::uint8_t> parts;  // per triangle: number of the look; empty for all 0
  bool is_breakable = true;         // scripted ones are not
  double element_size = 0.0;        // m, of the tetrahedra that its stress is told by; 0: about 10000 of them
  int grading = 1;                  // 1, 2, 4 or 8: so many times as large they become inside
  std::vector<HalfSpace> held;      // what lies in all of these is held by the world; empty: a free body
};

struct BoxDescription {
  Vec3 half_extent = Vec3::Constant(0.5);  // m
};

struct SphereDescription {
  double radius = 0.5;  // m
};

/// A cylinder about the y axis with a half sphere on either end.
struct CapsuleDescription {
  double radius = 0.25;  // m
  double length = 1.0;   // m, from tip to tip; more than twice the radius
};

/// The half space y <= 0 of the body's own frame is solid. Never dynamic; scripted ones do not turn.
struct PlaneDescription {};

/// The way of a scripted body, of its own frame. Times since it came in. Where it is added does not matter.
struct PathDescription {
  std::vector<body::Keyframe> keys;  // at least one; times ascending
  body::Between between = body::Between::smooth;
  Quat turn = Quat::Identity();  // of the body on its way, after its keys' angles
  Vec3 pivot = Vec3::Zero();     // m: the point of its own frame that goes this way, and that it turns about
};

struct BodyDescription {
  std::string name;
  std::variant<PlaneDescription, BoxDescription, SphereDescription, CapsuleDescription, ShellDescription,
               SolidDescription>
      form;
  int material = 0;                             // from World::add_material
  body::Motion motion = body::Motion::dynamic;  // what is clamped or held is always fixed
  Pose pose;                                    // of the mesh's (or the analytic form's) own frame
  std::optional<PathDescription> path;          // of a scripted body; without one it goes on at its velocity
  Vec3 velocity = Vec3::Zero();                 // of the centre of mass, m/s
  Vec3 angular_velocity = Vec3::Zero();         // rad/s, world
  Vec3 force = Vec3::Zero();   // N, world, at the centre of mass, all the time: pieces share it by mass
  Vec3 torque = Vec3::Zero();  // N m, world, of the whole body: pieces have none
  // Of dynamic ones: what breaks off is free, what is left with more than half of the mass is not.
  body::LockedAxes locked;
  int group = -1;                          // bodies of one group >= 0 do not collide
  std::optional<double> density;           // kg/m3, instead of the material's
  std::optional<double> contact_duration;  // s, of every impact on this body
};

/// Mortar wherever two bodies face each other no further apart than `gap`: it holds them as one.
struct MortarDescription {
  double gap = 1e-3;  // m
};

/// Two bodies share a point, about which they turn freely. Those that touch there do not collide with each
/// other; those that are apart, by a thousandth of the smaller one's radius, do.
struct PivotDescription {
  Vec3 point = Vec3::Zero();  // m, world
  double area = 1e-4;         // m2, over which its force is spread
};

struct JointDescription {
  std::string name;
  body::BodyId body_a = 0, body_b = 0;
  std::variant<MortarDescription, PivotDescription> form;
  double strength = 0.3e6;        // Pa, in tension
  double shear_strength = 0.3e6;  // Pa, without pressure, which adds friction; unused of a pivot
};

/// Friction and restitution of two materials, instead of the geometric mean and the lesser of theirs.
struct PairOverride {
  int material_a = 0, material_b = 0;
  std::optional<double> friction;
  std::optional<double> restitution;
};

}  // namespace shatterbox::world
