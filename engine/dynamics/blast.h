// What an explosion in free air gives to bodies: the law of its impulse, and its sum over what a body turns
// to it. [Sad52]: at the distance R (m) of W kg of TNT the blast passes with i = 200 W^(2/3) / R Pa s,
// in 1.2e-3 W^(1/6) R^(1/2) s. Energy makes W (4.184 MJ/kg). A surface that it meets under the angle a from
// its normal takes i (1 + 3 cos^2 a - 2 cos a) [RPB97], with the doubling of a weak shock for what is met
// squarely. The blast goes straight: who stands in its way shades others, and nothing goes round corners; gas
// that is shut in, and the ground's echo, are not in the law.
#pragma once

#include <span>
#include <vector>

#include "engine/body/body.h"
#include "engine/dynamics/line_of_sight.h"

namespace shatterbox::dynamics {

struct Blast {
  Vec3 centre = Vec3::Zero();  // m
  double energy = 0.0;         // J
  double duration = 0.0;       // s; 0: by the law
};

/// Pa s, of the free blast at a distance (m).
double free_impulse(double energy, double distance);

/// s, that the blast takes to pass at a distance (m).
double blast_duration(double energy, double distance);

/// What a part of a body's surface takes.
struct BlastPatch {
  Vec3 point = Vec3::Zero();    // m, world: its middle, by impulse
  Vec3 impulse = Vec3::Zero();  // N s, world
  double area = 0.0;            // m2
  double duration = 0.0;        // s
};

/// The patches of a body that see the blast, by place in the body's own frame; of planes none. A body takes
/// no more kinetic energy than the share of the blast's energy that goes its way, by solid angle.
std::vector<BlastPatch> find_blast_patches(const Blast& blast, const body::Body& body,
                                           const LineOfSight& sight);

}  // namespace shatterbox::dynamics
