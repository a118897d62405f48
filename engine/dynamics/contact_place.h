// Where a contact is once its bodies have moved: its points, gap and axes at poses within the step.
#pragma once

#include "engine/dynamics/motion_work.h"

namespace shatterbox::dynamics {

/// A body within the step.
struct Moved {
  Vec3 way = Vec3::Zero();       // m, of the centre since the start of the step
  Mat3 turn = Mat3::Identity();  // since then, of all but spheres
};

/// A contact at such poses.
struct PlacedContact {
  Vec3 arm_a = Vec3::Zero(), arm_b = Vec3::Zero();  // m, from the centres to its points
  Vec3 normal = Vec3::UnitY();                      // unit, from b towards a
  double gap = 0.0;                                 // m, along it
};

/// Points of faces and edges go with their bodies, and so does the normal that they make; what a sphere or a
/// capsule touches with is whatever point is lowest.
PlacedContact place_contact(const WorkBody& a, const Moved& moved_a, const WorkBody& b, const Moved& moved_b,
                            const collision::Contact& found);

/// Puts the solver's axes as they are at the start of the step.
void reset_axes(SolverContact& contact);

/// Lays them along a new normal; what the contact gave in this substep stays the same vector in the world.
void turn_axes(SolverContact& contact, const Vec3& normal);

}  // namespace shatterbox::dynamics
