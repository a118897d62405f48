// Joints behind the door: how they are made, what they can bear, and whether what they bore opens them. The
// law is that of breaking: contact as a mean over a fixed time, collisions summed over an event and divided
// by the impact's own duration, both added as forces; so the step does not matter.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "engine/body/impulse_log.h"
#include "engine/core/result.h"
#include "engine/dynamics/contact_settings.h"
#include "engine/dynamics/joint.h"
#include "engine/geometry/facing_area.h"
#include "engine/world/description.h"
#include "engine/world/settings.h"

namespace shatterbox::world {

/// What never changes of a joint.
struct JointNature {
  int number = 0;
  std::string name;
  double strength = 0.0;        // Pa, in tension; of a pivot over its area, in any direction
  double shear_strength = 0.0;  // Pa, without pressure
  double friction = 0.0;        // by which pressure adds to it
  std::vector<Vec2> outline;    // m, of the area, along its axes; none of a pivot
};

/// What a joint remembers of its loads between steps. Part of the state.
struct JointMemory {
  struct Load {
    double time = 0.0;            // s, when its part of a step began
    Vec3 impulse = Vec3::Zero();  // N s, in the joint's axes
    Vec3 couple = Vec3::Zero();   // N m s
  };
  std::vector<Load> contact;                                       // of the last kContactAverage
  Vec3 event_impulse = Vec3::Zero(), event_couple = Vec3::Zero();  // of the collisions under way
  double event_duration = 0.0;                                     // s; 0: there is none
  double event_time = -1e9;                                        // s, of its last collision
};
using JointMemories = std::map<int, JointMemory>;  // by number

/// What a joint bears, and how near it is to opening.
struct JointVerdict {
  int number = 0;
  Vec3 force = Vec3::Zero();   // N on a, in the joint's axes: x from b to a
  Vec3 moment = Vec3::Zero();  // N m
  double tension = 0.0;        // Pa, greatest at the rim of the area; less than 0: all of it is pressed
  double shear = 0.0;          // Pa
  double ratio = 0.0;          // of what it can bear; it opens from 1 on
  bool is_by_shear = false;
  bool is_struck = false;  // a collision is in it
};

/// Mean stress and bending at the rim against tension; mean shear and twist against cohesion and friction.
JointVerdict judge_joint(const dynamics::Joint& joint, const JointNature& nature, const Vec3& force,
                         const Vec3& moment);

/// When a part of a step was taken.
struct PartTime {
  double step_start = 0.0;  // s
  double start = 0.0;       // s
  double length = 0.0;      // s
  double average = 0.0;     // s, over which contact is averaged
};

/// Of all joints, by what they gave in this part and `log`, which goes with it. Writes `memories`.
std::vector<JointVerdict> judge_joints(const std::vector<dynamics::Joint>& joints,
                                       const std::vector<JointNature>& natures,
                                       const std::vector<body::Body>& bodies, const body::ImpulseLog& log,
                                       const WorldSettings& settings,
                                       const dynamics::ContactSettings& contact, const PartTime& part,
                                       JointMemories& memories);

/// Numbers of those overloaded at least so much that give way, ascending: of each chain of points one, for
/// the others are eased by that. `verdicts` are of all `joints`, in their order.
std::vector<int> find_opening(std::span<const JointVerdict> verdicts, double least,
                              const std::vector<dynamics::Joint>& joints,
                              const std::vector<body::Body>& bodies);

/// The area over which two bodies face each other no further apart than `gap` (m), in the world; none of a
/// sphere.
geometry::FacingArea find_mortar_area(const body::Body& a, const body::Body& b, double gap);

/// Joints of a body that broke, as it was in `parent`, go on with that piece of `born` which is nearest to
/// them. Taken away and returned, by number, are those from which it is further than it is across: what hung
/// there was all of the body.
[[nodiscard]] std::vector<int> rehang(std::vector<dynamics::Joint>& joints, const body::Body& parent,
                                      const std::vector<body::BodyId>& born,
                                      const std::vector<body::Body>& bodies);

}  // namespace shatterbox::world
