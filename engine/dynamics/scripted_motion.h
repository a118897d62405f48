// Bodies that follow a path of their own whatever they meet, until something that cannot give way is in it:
// that they strike, or stop at, and come on when they can.
#pragma once

#include <vector>

#include "engine/body/body.h"

namespace shatterbox::dynamics {

struct WorkBody;

/// Gives scripted bodies the velocities that lead them, in `time_step` seconds, to where they are to be, or
/// as far towards it as they may go; none to those that are there and rest, or wait.
void aim_scripted(std::vector<body::Body>& bodies, double time_step);

/// Fills the rides of a scripted body that moves: along its path if it is on it and keeps up, else straight.
void plan_rides(const body::Body& body, double time_step, int substeps, WorkBody& work);

/// Lets a scripted body go no further than it is after so many substeps.
void hold_up(WorkBody& body, int substeps);

/// What became of a scripted body's step: its velocity, and how it comes on after it was held up.
void end_scripted(const WorkBody& work, body::Body& body);

/// Whether it is on a path, as something that has a mass, and does not strike yet.
bool can_strike(const body::Body& body);

/// Makes a scripted body a free one, of its mass and the velocity that its path gave it, in a part of a step.
/// Where its path does not turn it nothing does.
void begin_strike(body::Body& body);

/// What became of one that struck: it was held up by what it met, and will be heavier next time.
void end_blow(const WorkBody& work, body::Body& body);

/// Those that struck are driven again.
void end_strikes(std::vector<body::Body>& bodies);

/// Those of `bodies` that strike in `struck`, which broke of it, press on no harder for it.
void forget_blows(const std::vector<body::Body>& struck, std::vector<body::Body>& bodies);

/// How far the farthest point of the body is from where it is to be, m, at most; 0 unless it has a path.
double distance_behind(const body::Body& body);

}  // namespace shatterbox::dynamics
